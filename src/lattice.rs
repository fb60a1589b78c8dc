//! Which samples a ray caster takes: CPU references of `shaders/lib/lattice_ray.wgsl`, `lattice_planes.wgsl` and
//! `lattice_bresenham.wgsl`.
//!
//! ```text
//! ray:        t = t0 + (k + 1/2) h, by multiplication; the last, shorter segment at its own middle
//! jitter:     t0 less a part of h that depends on the pixel; the first, shorter segment at its own middle too
//! planes:     n . (o + t r) = (k + 1/2) h + c, a sample stands for h / (n . r)
//! bresenham:  (o + t d)_k = (j + 1/2) / D, k the main axis of the ray in voxel space, a sample stands for 1 / (D |d_k|)
//! ```

use crate::blue_noise::jitter_of;
use crate::ray::{Ray, plane_height, plane_length, plane_t, vector};
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

/// Equal steps from where a ray enters, or with jitter from a part of a step before.
#[derive(Clone, Copy, Debug)]
struct Steps<R> {
    /// Where the ray is in the domain.
    ends: [R; 2],
    /// Where the first step begins.
    start: R,
    step: R,
    /// How many whole steps end in the domain.
    full: i32,
}

impl<R: Real> Steps<R> {
    fn new(frame: &Frame, pixel: [R; 2], ends: [R; 2]) -> Self {
        let step = R::from_f32(frame.step_world);
        let mut start = ends[0];
        if frame.is_jittered != 0 {
            let place = pixel.map(|x| x.to_i32() as u32);
            start = start + (R::from_f32(jitter_of(frame, place)) - R::from_f64(1.0)) * step;
        }
        Self {
            ends,
            start,
            step,
            full: ((ends[1] - start) / step).floor().to_i32(),
        }
    }

    /// Where so many steps after the first begins.
    fn at(&self, steps: R) -> R {
        self.start + steps * self.step
    }

    /// Step `k`, cut to where the ray is in the domain.
    fn slab(&self, k: i32) -> Slab<R> {
        let index = R::from_f64(f64::from(k));
        let [t0, t1] = self.ends;
        let (enter, is_last) = (self.at(index), k == self.full);
        let front = enter.max(t0);
        let back = if is_last {
            t1
        } else {
            self.at(index + R::from_f64(1.0))
        };
        let is_whole = !is_last && enter >= t0;
        Slab {
            ends: [front, back],
            length: if is_whole { self.step } else { back - front },
        }
    }
}

/// Samples at equal steps from where the ray enters.
pub fn along_ray<R: Real>(
    frame: &Frame,
    pixel: [R; 2],
    ends: [R; 2],
) -> impl Iterator<Item = Segment<R>> {
    let steps = Steps::new(frame, pixel, ends);
    let half = R::from_f64(0.5);
    (0..=steps.full).map(move |k| {
        let index = R::from_f64(f64::from(k));
        if k < steps.full && steps.at(index) >= ends[0] {
            return Segment {
                t: steps.at(index + half),
                length: steps.step,
            };
        }
        let slab = steps.slab(k);
        let length = slab.length.max(R::from_f64(0.0));
        Segment {
            t: slab.ends[0] + half * length,
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
    let origin = plane_height(frame, world);
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

/// Of axes whose slopes differ by less, in parts, the lowest is taken: rounding does not choose among those that are equal.
const MAIN_AXIS_SHARE: f64 = 1.0 - 1.0 / 65536.0;

/// The main axis of a ray of this direction in voxel space: the lowest of those that it runs along most.
pub fn main_axis<R: Real>(direction: [R; 3]) -> usize {
    let slopes = direction.map(R::abs);
    let largest = slopes[0].max(slopes[1].max(slopes[2]));
    let enough = R::from_f64(MAIN_AXIS_SHARE) * largest;
    // Not a number is along no axis, and takes the one that is left.
    (0..2).find(|&k| slopes[k] >= enough).unwrap_or(2)
}

/// Samples where the ray meets the heights (j + 1/2) / D of its main axis, D the samples per voxel.
pub fn on_main_axis<R: Real>(
    frame: &Frame,
    voxel: &Ray<R>,
    [t0, t1]: [R; 2],
) -> impl Iterator<Item = Segment<R>> {
    let k = main_axis(voxel.direction);
    let (half, one) = (R::from_f64(0.5), R::from_f64(1.0));
    let per_voxel = R::from_f32(frame.samples_per_voxel);
    let slope = voxel.direction[k].abs();
    // Along a ray that falls, heights count down: those of the mirrored axis are the same ones.
    let height = match voxel.direction[k] < R::from_f64(0.0) {
        true => -voxel.origin[k],
        false => voxel.origin[k],
    };
    let index_at = |t: R| (height + t * slope) * per_voxel - half;
    // One height more at each end: rounding may not lose one, the filter has the last word.
    let indices = index_at(t0).floor().to_i32()..=index_at(t1).ceil().to_i32();
    let length = one / (per_voxel * slope);
    let segments = indices.map(move |i| Segment {
        t: ((R::from_f64(f64::from(i)) + half) / per_voxel - height) / slope,
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

/// Slabs of one step each; the last is shorter, and with jitter the first too. CPU reference of `slab_ray.wgsl`.
pub fn slabs_along_ray<R: Real>(
    frame: &Frame,
    pixel: [R; 2],
    ends: [R; 2],
) -> impl Iterator<Item = Slab<R>> {
    let steps = Steps::new(frame, pixel, ends);
    (0..=steps.full).map(move |k| steps.slab(k))
}

/// The slab around plane `k`, cut to the interval. CPU reference of `slab.wgsl`.
pub fn plane_slab<R: Real>(frame: &Frame, world: &Ray<R>, interval: [R; 2], k: i32) -> Slab<R> {
    let forward = vector(frame.forward);
    let (origin, slope) = (plane_height(frame, world), dot(forward, world.direction));
    let step = R::from_f32(frame.step_world);
    let edge = |k: i32| (R::from_f64(f64::from(k)) * step - origin) / slope;
    Slab::cut([edge(k), edge(k + 1)], interval, plane_length(frame, world))
}

/// Slabs around the planes of a view-aligned slicer. CPU reference of `slab_planes.wgsl`.
pub fn slabs_on_planes<R: Real>(
    frame: &Frame,
    world: &Ray<R>,
    [t0, t1]: [R; 2],
) -> impl Iterator<Item = Slab<R>> {
    let forward = vector(frame.forward);
    let (origin, slope) = (plane_height(frame, world), dot(forward, world.direction));
    let plane_at = |t: R| (origin + t * slope) / R::from_f32(frame.step_world) - R::from_f64(0.5);
    let planes = plane_at(t0).floor().to_i32()..=plane_at(t1).ceil().to_i32();
    planes.map(move |k| plane_slab(frame, world, [t0, t1], k))
}
