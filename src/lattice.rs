//! Which samples a ray caster takes: twins of `shaders/lib/lattice_ray.wgsl` and `lattice_planes.wgsl`.
//!
//! ```text
//! ray:     t = t0 + (k + 1/2) h, by multiplication; the last, shorter segment at its own middle
//! planes:  n . (o + t r) = (k + 1/2) h, a sample stands for h / (n . r)
//! ```

use crate::ray::{Ray, plane_length, plane_t, vector};
use crate::real::{Real, dot};
use crate::shaders::Frame;

/// A piece of a ray, sampled at `t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<R> {
    /// World length from the ray's origin.
    pub t: R,
    /// World length that the sample stands for.
    pub length: R,
}

/// Samples at equal steps from where the ray enters.
pub fn along_ray<R: Real>(frame: &Frame, [t0, t1]: [R; 2]) -> impl Iterator<Item = Segment<R>> {
    let step = R::from_f32(frame.step_world);
    let half = R::from_f64(0.5);
    let full = ((t1 - t0) / step).floor().to_i32();
    (0..=full).map(move |k| {
        let index = R::from_f64(f64::from(k));
        if k < full {
            return Segment {
                t: t0 + (index + half) * step,
                length: step,
            };
        }
        let start = t0 + index * step;
        let length = (t1 - start).max(R::from_f64(0.0));
        Segment {
            t: start + half * length,
            length,
        }
    })
}

/// Samples where the ray meets the planes of a view-aligned slicer.
pub fn on_planes<R: Real>(
    frame: &Frame,
    world: &Ray<R>,
    [t0, t1]: [R; 2],
) -> impl Iterator<Item = Segment<R>> {
    let forward = vector(frame.forward);
    let origin = dot(forward, world.origin);
    let slope = dot(forward, world.direction);
    let plane_at = |t: R| (origin + t * slope) / R::from_f32(frame.step_world) - R::from_f64(0.5);
    // One plane more at each end: rounding may not lose one, the filter has the last word.
    let planes = plane_at(t0).floor().to_i32()..=plane_at(t1).ceil().to_i32();
    let length = plane_length(frame, world);
    let segments = planes.map(move |k| Segment {
        t: plane_t(frame, world, k),
        length,
    });
    segments.filter(move |segment| t0 <= segment.t && segment.t < t1)
}

/// A piece of a ray between two ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slab<R> {
    /// Where it begins and where it ends, in world length from the ray's origin.
    pub ends: [R; 2],
    /// Its length.
    pub length: R,
}

impl<R: Real> Slab<R> {
    /// Its middle, and its length.
    pub fn segment(&self) -> Segment<R> {
        Segment {
            t: R::from_f64(0.5) * (self.ends[0] + self.ends[1]),
            length: self.length,
        }
    }

    /// What is left between `t0` and `t1`; a piece that is not cut keeps `length`.
    pub fn cut([enter, leave]: [R; 2], [t0, t1]: [R; 2], length: R) -> Self {
        let ends = [enter.max(t0), leave.min(t1)];
        let is_whole = ends == [enter, leave];
        Self {
            ends,
            length: if is_whole { length } else { ends[1] - ends[0] },
        }
    }
}

/// Slabs of one step each from where the ray enters; the last is shorter. Twin of `slab_ray.wgsl`.
pub fn slabs_along_ray<R: Real>(frame: &Frame, [t0, t1]: [R; 2]) -> impl Iterator<Item = Slab<R>> {
    let step = R::from_f32(frame.step_world);
    let full = ((t1 - t0) / step).floor().to_i32();
    let edge = move |k: i32| t0 + R::from_f64(f64::from(k)) * step;
    (0..=full).map(move |k| {
        let (front, is_last) = (edge(k), k == full);
        Slab {
            ends: [front, if is_last { t1 } else { edge(k + 1) }],
            length: if is_last { t1 - front } else { step },
        }
    })
}

/// The slab around plane `k`, cut to the interval. Twin of `slab.wgsl`.
pub fn plane_slab<R: Real>(frame: &Frame, world: &Ray<R>, interval: [R; 2], k: i32) -> Slab<R> {
    let forward = vector(frame.forward);
    let (origin, slope) = (dot(forward, world.origin), dot(forward, world.direction));
    let step = R::from_f32(frame.step_world);
    let edge = |k: i32| (R::from_f64(f64::from(k)) * step - origin) / slope;
    Slab::cut([edge(k), edge(k + 1)], interval, plane_length(frame, world))
}

/// Slabs around the planes of a view-aligned slicer. Twin of `slab_planes.wgsl`.
pub fn slabs_on_planes<R: Real>(
    frame: &Frame,
    world: &Ray<R>,
    [t0, t1]: [R; 2],
) -> impl Iterator<Item = Slab<R>> {
    let forward = vector(frame.forward);
    let (origin, slope) = (dot(forward, world.origin), dot(forward, world.direction));
    let plane_at = |t: R| (origin + t * slope) / R::from_f32(frame.step_world) - R::from_f64(0.5);
    let planes = plane_at(t0).floor().to_i32()..=plane_at(t1).ceil().to_i32();
    planes.map(move |k| plane_slab(frame, world, [t0, t1], k))
}

/// Where the steps of a pixel's ray begin, over 0 and at most 1. Twin of `jitter.wgsl`.
pub fn jitter_of(frame: &Frame, pixel: [u32; 2]) -> f32 {
    let [x, y] = pixel;
    let pattern = x
        .wrapping_mul(3_242_174_889)
        .wrapping_add(y.wrapping_mul(2_447_445_414))
        .wrapping_add(frame.jitter);
    ((pattern >> 8) as f32 + 0.5) / 16_777_216.0
}

/// Steps of which the first is cut short, as slabs. Twin of `slab_jitter.wgsl` and `lattice_jitter.wgsl`.
pub fn slabs_jittered<R: Real>(
    frame: &Frame,
    pixel: [R; 2],
    [t0, t1]: [R; 2],
) -> impl Iterator<Item = Slab<R>> {
    let step = R::from_f32(frame.step_world);
    let place = pixel.map(|x| x.to_i32() as u32);
    let start = t0 + (R::from_f32(jitter_of(frame, place)) - R::from_f64(1.0)) * step;
    let full = ((t1 - start) / step).floor().to_i32();
    let edge = move |k: i32| start + R::from_f64(f64::from(k)) * step;
    (0..=full).map(move |k| Slab::cut([edge(k), edge(k + 1)], [t0, t1], step))
}
