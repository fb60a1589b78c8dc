//! View-aligned slicing on the CPU: CPU reference of `shaders/slices_3d.wgsl`.

use crate::lattice::plane_slab;
use crate::ray::{domain_interval, pixel_ray, plane_length, plane_t, visible_interval, voxel_ray};
use crate::real::Real;
use crate::shaders::Frame;
use crate::technique::blend::Fragment;
use crate::technique::reference::{Gathered, Samples, SlabValues, composited, moved, projected};
use std::cmp::Ordering;

/// What the slices of a pixel gather.
pub(crate) fn pixel<R: Real>(of: &impl Samples<R>, pixel: [R; 2]) -> Gathered<R> {
    let (frame, settings) = (&of.frame_of(pixel), of.settings());
    let plane = |i| plane_of(frame, i);
    let value_at = |p| of.value(p);
    if settings.mode.is_projection() {
        return projected(of, |i| fragment(frame, pixel, plane(i), value_at));
    }
    let ray_direction = pixel_ray(frame, pixel).direction;
    if settings.preintegrated {
        let material_of = |slab: SlabValues<R>| {
            let tap = |step| of.value(moved(slab.middle, step));
            of.material_of_slab(slab, ray_direction, tap)
        };
        return composited(of, |i| {
            let slab = slab(frame, pixel, plane(i), value_at)?;
            Some(slab.map(|found| found.map(material_of)))
        });
    }
    let material_at = |p| of.material(p, ray_direction);
    composited(of, |i| fragment(frame, pixel, plane(i), material_at))
}

/// The plane that instance `instance` shows.
pub(crate) fn plane_of(frame: &Frame, instance: u32) -> i32 {
    frame.slice_first + instance as i32 * frame.slice_direction
}

/// The sample of a pixel's ray on one plane; `None` outside the domain, `Some(None)` for no data.
pub fn fragment<R: Real, V>(
    frame: &Frame,
    pixel: [R; 2],
    plane: i32,
    value_at: impl Fn([R; 3]) -> Option<V>,
) -> Option<Option<Fragment<R, V>>> {
    let world = pixel_ray(frame, pixel);
    let voxel = voxel_ray(frame, &world);
    let [t0, t1] = visible_interval(frame, domain_interval(frame, &world, &voxel), &world);
    let t = plane_t(frame, &world, plane);
    if !(t0 <= t && t < t1) {
        return None;
    }
    let length = plane_length(frame, &world);
    Some(value_at(voxel.at(t)).map(|value| Fragment { value, length }))
}

/// The slab of a pixel's ray around one plane: CPU reference of `shaders/slices_3d_slab.wgsl`.
pub fn slab<R: Real>(
    frame: &Frame,
    pixel: [R; 2],
    plane: i32,
    value_at: impl Fn([R; 3]) -> Option<R>,
) -> Option<Option<Fragment<R, SlabValues<R>>>> {
    let world = pixel_ray(frame, pixel);
    let voxel = voxel_ray(frame, &world);
    let interval = visible_interval(frame, domain_interval(frame, &world, &voxel), &world);
    let slab = plane_slab(frame, &world, interval, plane);
    if slab.length.partial_cmp(&R::from_f64(0.0)) != Some(Ordering::Greater) {
        return None;
    }
    let [front, back] = slab.ends.map(|t| value_at(voxel.at(t)));
    let middle = voxel.at(slab.segment().t);
    let ends = front.and_then(|front| Some([front, back?]));
    Some(ends.map(|ends| Fragment {
        value: SlabValues { ends, middle },
        length: slab.length,
    }))
}
