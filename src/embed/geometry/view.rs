//! A host's camera and depths as the shaders of geometry want them: `shaders/lib/geometry_view.wgsl`.

use crate::camera::{Camera, HostDepth};
use crate::picture::ColorSpace;
use crate::shaders::{GeometryView, GeometryViewFields};
use crate::technique::clip_rows;
use glam::DVec3;

/// The parameters of one draw of places that count from `center`.
pub(super) fn view(
    camera: &Camera,
    depth: &HostDepth,
    center: DVec3,
    extent: [u32; 2],
    color_space: ColorSpace,
) -> GeometryView {
    let mut rays = camera.rays(extent);
    rays.origin -= center;
    let HostDepth { z, w, nearer } = depth.centered(center);
    let near = z - nearer.near() * w;
    let origin = rays.origin.extend(1.0);
    let is_perspective = camera.projection.is_perspective();
    let [right, down] = match is_perspective {
        true => [rays.direction_dx, rays.direction_dy],
        false => [rays.origin_dx, rays.origin_dy],
    }
    .map(|pixel| pixel / pixel.length_squared());
    let [right_start, down_start] = match is_perspective {
        true => [right.dot(rays.direction), down.dot(rays.direction)],
        false => [0.0; 2],
    };
    let [x_clip, y_clip, ..] = clip_rows(&rays, extent);
    let [z_clip, w_clip] = [z, w].map(|row| row.as_vec4().to_array());
    let v = |v: DVec3| v.as_vec3().to_array();
    GeometryViewFields {
        origin: v(rays.origin),
        is_perspective: is_perspective.into(),
        origin_dx: v(rays.origin_dx),
        z_origin: z.dot(origin) as f32,
        origin_dy: v(rays.origin_dy),
        w_origin: w.dot(origin) as f32,
        direction: v(rays.direction),
        near_origin: near.dot(origin) as f32,
        direction_dx: v(rays.direction_dx),
        far: 1.0 - nearer.near() as f32,
        direction_dy: v(rays.direction_dy),
        color_space_is_display: (color_space == ColorSpace::Display).into(),
        near: v(near.truncate()),
        right_start: right_start as f32,
        forward: v(rays.forward),
        down_start: down_start as f32,
        right: v(right),
        down: v(down),
        z: v(z.truncate()),
        w: v(w.truncate()),
        extent_pixels: extent.map(|n| n as f32),
        clip_from_place: [x_clip, y_clip, z_clip, w_clip],
    }
    .into()
}
