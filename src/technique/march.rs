//! The walk along one ray that every compute pass shares: twin of `shaders/lib/march.wgsl`.

use super::Lattice;
use crate::lattice::{Segment, Slab, along_ray, on_planes, slabs_along_ray, slabs_on_planes};
use crate::ray::{domain_interval, pixel_ray, voxel_ray};
use crate::real::Real;
use crate::shaders::Frame;
use std::ops::ControlFlow;

/// Hands each valid sample of a pixel's ray to `add` until that breaks, and returns how many samples were
/// taken. `value_at` is the filter: a position in voxel space to a value, `None` for no data.
pub fn march<R: Real, V>(
    frame: &Frame,
    lattice: Lattice,
    pixel: [R; 2],
    value_at: impl Fn([R; 3]) -> Option<V>,
    mut add: impl FnMut(V, Segment<R>) -> ControlFlow<()>,
) -> u32 {
    let world = pixel_ray(frame, pixel);
    let voxel = voxel_ray(frame, &world);
    let interval = domain_interval(frame, &world, &voxel);
    if interval[0] >= interval[1] {
        return 0;
    }
    let mut samples = 0;
    let mut take = |segment: Segment<R>| {
        samples += 1;
        match value_at(voxel.at(segment.t)) {
            Some(value) => add(value, segment),
            None => ControlFlow::Continue(()),
        }
    };
    // What breaks the walk is the mode's own affair; here it only ends.
    let has_length = |s: &Segment<R>| s.length > R::from_f64(0.0);
    let _ended = match lattice {
        Lattice::Ray | Lattice::Jitter => along_ray(frame, pixel, interval)
            .filter(has_length)
            .try_for_each(&mut take),
        Lattice::Planes => on_planes(frame, &world, interval).try_for_each(&mut take),
    };
    samples
}

/// The same walk in slabs, each with the values at its two ends: twin of `shaders/lib/march_slab.wgsl`.
pub fn march_slabs<R: Real>(
    frame: &Frame,
    lattice: Lattice,
    pixel: [R; 2],
    value_at: impl Fn([R; 3]) -> Option<R>,
    mut add: impl FnMut([R; 2], Segment<R>) -> ControlFlow<()>,
) -> u32 {
    let world = pixel_ray(frame, pixel);
    let voxel = voxel_ray(frame, &world);
    let interval = domain_interval(frame, &world, &voxel);
    if interval[0] >= interval[1] {
        return 0;
    }
    let mut samples = 0;
    let mut take = |slab: Slab<R>| {
        // Not a number is no length either.
        if slab.length.partial_cmp(&R::from_f64(0.0)) != Some(std::cmp::Ordering::Greater) {
            return ControlFlow::Continue(());
        }
        samples += 1;
        match slab.ends.map(|t| value_at(voxel.at(t))) {
            [Some(front), Some(back)] => add([front, back], slab.segment()),
            _ => ControlFlow::Continue(()),
        }
    };
    // As above.
    let _ended = match lattice {
        Lattice::Ray | Lattice::Jitter => {
            slabs_along_ray(frame, pixel, interval).try_for_each(&mut take)
        }
        Lattice::Planes => slabs_on_planes(frame, &world, interval).try_for_each(&mut take),
    };
    samples
}
