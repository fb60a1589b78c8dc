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
