//! The walk along one ray that every compute pass shares: CPU reference of `shaders/lib/march.wgsl`.

use super::Lattice;
use crate::lattice::{
    Segment, Slab, along_ray, on_main_axis, on_planes, slabs_along_ray, slabs_on_planes,
};
use crate::ray::{domain_interval, pixel_ray, visible_interval, voxel_ray};
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
    let interval = visible_interval(frame, domain_interval(frame, &world, &voxel), &world);
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
        Lattice::Bresenham => on_main_axis(frame, &voxel, interval).try_for_each(&mut take),
    };
    samples
}

/// The same walk in which one sample, that in the middle, stands for all that follow each other in a cell: CPU reference of
/// `shaders/lib/unroll_adaptive.wgsl`. `cell_at` names the cell of a position where samples look alike.
pub fn march_in_runs<R: Real, V>(
    frame: &Frame,
    pixel: [R; 2],
    cell_at: impl Fn([R; 3]) -> Option<usize>,
    value_at: impl Fn([R; 3]) -> Option<V>,
    mut add: impl FnMut(V, Segment<R>) -> ControlFlow<()>,
) -> u32 {
    let world = pixel_ray(frame, pixel);
    let voxel = voxel_ray(frame, &world);
    let interval = visible_interval(frame, domain_interval(frame, &world, &voxel), &world);
    if interval[0] >= interval[1] {
        return 0;
    }
    let step = R::from_f32(frame.step_world);
    let segments = along_ray(frame, pixel, interval).filter(|s| s.length > R::from_f64(0.0));
    let segments: Vec<Segment<R>> = segments.collect();
    let cell_of = |segment: &Segment<R>| {
        let is_whole = segment.length == step;
        cell_at(voxel.at(segment.t)).filter(|_| is_whole)
    };
    let runs = segments.chunk_by(|a, b| match (cell_of(a), cell_of(b)) {
        (Some(a), Some(b)) => a == b,
        _ => false,
    });
    let mut samples = 0;
    for run in runs {
        let middle = run[(run.len() - 1) / 2];
        let segment = Segment {
            t: middle.t,
            length: R::from_f64(run.len() as f64) * middle.length,
        };
        samples += 1;
        if let Some(value) = value_at(voxel.at(segment.t))
            && add(value, segment).is_break()
        {
            break;
        }
    }
    samples
}

/// The same walk in slabs, each with the values at its two ends: CPU reference of `shaders/lib/march_slab.wgsl`.
pub fn march_slabs<R: Real>(
    frame: &Frame,
    lattice: Lattice,
    pixel: [R; 2],
    value_at: impl Fn([R; 3]) -> Option<R>,
    mut add: impl FnMut([R; 2], Segment<R>) -> ControlFlow<()>,
) -> u32 {
    let world = pixel_ray(frame, pixel);
    let voxel = voxel_ray(frame, &world);
    let interval = visible_interval(frame, domain_interval(frame, &world, &voxel), &world);
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
        // Settings that ask for it are refused.
        Lattice::Bresenham => unreachable!("no slabs lie between heights of a main axis"),
    };
    samples
}
