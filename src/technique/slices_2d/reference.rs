//! 2D texture slicing on the CPU: twin of `shaders/slices_2d.wgsl` and of its cover's order.

use crate::ray::{domain_interval, pixel_ray, voxel_ray};
use crate::real::Real;
use crate::shaders::Frame;
use crate::technique::blend::Fragment;

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
    let [t0, t1] = domain_interval(frame, &world, &voxel);
    let center = R::from_f64(f64::from(slice)) + R::from_f64(0.5);
    let t = (center - voxel.origin[axis]) / slope;
    if !(t0 <= t && t < t1) {
        return None;
    }
    let length = R::from_f64(1.0) / slope.abs();
    Some(value_at(voxel.at(t)).map(|value| Fragment { value, length }))
}
