//! Which view-aligned planes are drawn, and in which order.
//!
//! Plane k is forward . x = (k + 1/2) h around the centre of the grid box: anchored there and not at the
//! eye, planes stay with the volume while the eye moves (`sampling.md` 3).

use crate::shaders::FrameFields;
use crate::technique::{Order, View};
use glam::{DVec3, dvec3};

/// Fills in the slice parameters for a part of the grid ([`View::part`]) and returns how many planes to draw.
pub fn set_planes(view: &View, part: [DVec3; 2], fields: &mut FrameFields) -> u32 {
    let [first, last] = plane_range(view, part);
    let count = (last - first + 1).max(0);
    (fields.slice_first, fields.slice_direction) = match view.settings.order {
        Order::BackToFront => (last, -1),
        Order::FrontToBack => (first, 1),
    };
    fields.slice_turn = count as u32;
    count as u32
}

/// The planes that meet the part in front of the eye, one more at each end against rounding.
fn plane_range(view: &View, [low, high]: [DVec3; 2]) -> [i32; 2] {
    let step = view.step_world();
    let forward = view.rays().forward;
    let world_from_voxel = view.world_from_voxel();
    let height = |i: u32| {
        let part = dvec3((i & 1).into(), (i >> 1 & 1).into(), (i >> 2).into());
        forward.dot(world_from_voxel.transform_point3(low + part * (high - low)))
    };
    let highest = (0..8).map(height).fold(f64::NEG_INFINITY, f64::max);
    // Nothing behind the eye is seen: rays start there, orthographic ones at the plane through it.
    let eye = forward.dot(view.camera.eye - view.grid.center());
    let lowest = (0..8).map(height).fold(f64::INFINITY, f64::min).max(eye);
    let plane_at = |height: f64| height / step - 0.5;
    [
        plane_at(lowest).floor() as i32,
        plane_at(highest).ceil() as i32,
    ]
}
