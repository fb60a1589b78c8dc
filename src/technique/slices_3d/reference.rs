//! View-aligned slicing on the CPU: twin of `shaders/slices_3d.wgsl`.

use crate::ray::{domain_interval, pixel_ray, plane_length, plane_t, voxel_ray};
use crate::real::Real;
use crate::shaders::Frame;
use crate::technique::blend::Fragment;

/// The sample of a pixel's ray on one plane; `None` outside the domain, `Some(None)` for no data.
pub fn fragment<R: Real, V>(
    frame: &Frame,
    pixel: [R; 2],
    plane: i32,
    value_at: impl Fn([R; 3]) -> Option<V>,
) -> Option<Option<Fragment<R, V>>> {
    let world = pixel_ray(frame, pixel);
    let voxel = voxel_ray(frame, &world);
    let [t0, t1] = domain_interval(frame, &world, &voxel);
    let t = plane_t(frame, &world, plane);
    if !(t0 <= t && t < t1) {
        return None;
    }
    let length = plane_length(frame, &world);
    Some(value_at(voxel.at(t)).map(|value| Fragment { value, length }))
}
