//! 2D texture slicing on the CPU: CPU reference of `shaders/slices_2d.wgsl` and of its cover's order.

use super::between::{self, Level};
use crate::ray::{domain_interval, pixel_ray, visible_interval, voxel_ray};
use crate::real::Real;
use crate::shaders::Frame;
use crate::technique::Filter;
use crate::technique::blend::Fragment;
use crate::technique::reference::{Gathered, Samples, SlabValues, composited, moved, projected};

/// What the slices of a pixel gather.
pub(crate) fn pixel<R: Real>(of: &impl Samples<R>, pixel: [R; 2]) -> Gathered<R> {
    let (frame, settings) = (&of.frame_of(pixel), of.settings());
    let axis = frame.slice_axis as usize;
    let slice = |i| slice_of(frame, i);
    let on_slice = |i| slice(i) as u32;
    if settings.mode.is_projection() {
        return projected(of, |i| {
            let value_at = |p| of.value_in_slice(axis, on_slice(i), p);
            fragment(frame, pixel, slice(i), value_at)
        });
    }
    let ray_direction = pixel_ray(frame, pixel).direction;
    let between = |level, p| value_between(of, level, p);
    let value_away = |p, step| {
        let p = moved(p, step);
        between(Level::at(p[axis]), p)
    };
    if settings.preintegrated {
        let material_of = |slab: SlabValues<R>| {
            of.material_of_slab(slab, ray_direction, |step| value_away(slab.middle, step))
        };
        return composited(of, |i| {
            let slab = between::slab(frame, pixel, slice(i), between)?;
            Some(slab.map(|found| found.map(material_of)))
        });
    }
    if settings.smooth {
        let material_at = |level, p| {
            let own = of.classify(between(level, p)?);
            Some(of.lit(own, p, ray_direction, |step| value_away(p, step)))
        };
        return composited(of, |i| {
            between::fragment(frame, pixel, slice(i), material_at)
        });
    }
    composited(of, |i| {
        let material_at = |p| of.material_in_slice(axis, on_slice(i), p, ray_direction);
        fragment(frame, pixel, slice(i), material_at)
    })
}

/// The volume's value between the slices of the stack.
fn value_between<R: Real>(of: &impl Samples<R>, level: Level<R>, p: [R; 3]) -> Option<R> {
    let axis = of.frame().slice_axis as usize;
    let slices = of.dim(axis);
    let in_slice = |slice| of.value_in_slice(axis, slice, p);
    match of.settings().filter {
        Filter::Nearest => in_slice(level.nearest(slices)),
        // Wide filters refuse planes between slices.
        _ => level.linear(slices, in_slice),
    }
}

/// The slice that instance `instance` shows.
pub fn slice_of(frame: &Frame, instance: u32) -> i32 {
    if instance < frame.slice_turn {
        return frame.slice_first + instance as i32 * frame.slice_direction;
    }
    frame.slice_first_after_turn - (instance - frame.slice_turn) as i32 * frame.slice_direction
}

/// The sample of a pixel's ray on one slice; `None` outside the domain, `Some(None)` for no data. `value_at`
/// filters inside the slice.
pub fn fragment<R: Real, V>(
    frame: &Frame,
    pixel: [R; 2],
    slice: i32,
    value_at: impl Fn([R; 3]) -> Option<V>,
) -> Option<Option<Fragment<R, V>>> {
    let world = pixel_ray(frame, pixel);
    let voxel = voxel_ray(frame, &world);
    let axis = frame.slice_axis as usize;
    let slope = voxel.direction[axis];
    // A ray inside the slice's plane never crosses it.
    if slope.abs() < R::from_f32(1e-20) {
        return None;
    }
    let [t0, t1] = visible_interval(frame, domain_interval(frame, &world, &voxel), &world);
    let center = R::from_f64(f64::from(slice)) + R::from_f64(0.5);
    let t = (center - voxel.origin[axis]) / slope;
    if !(t0 <= t && t < t1) {
        return None;
    }
    let length = R::from_f64(1.0) / slope.abs();
    Some(value_at(voxel.at(t)).map(|value| Fragment { value, length }))
}
