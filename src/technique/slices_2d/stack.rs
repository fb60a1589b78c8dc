//! Which of the three stacks is drawn, which of its slices, and in which order (`sampling.md` 3).
//!
//! The axis k of the largest |n_k . v|: n_k the normalized row k of `voxel_from_world`, v the unit vector
//! from the eye to the centre of the box (orthographic, or the eye at the centre: the forward vector). On
//! orthogonal grids that switches at 45 degrees; spacing does not weigh.

use crate::camera::Projection;
use crate::shaders::FrameFields;
use crate::technique::{Order, View};
use glam::DVec3;

/// Two axes that face the eye alike by this much are a tie: the lower one wins.
const TIE: f64 = 1e-12;

/// The axis whose slices face the eye most.
pub fn stack_axis(view: &View) -> usize {
    let forward = view.rays().forward;
    let towards = match view.camera.projection {
        Projection::Orthographic { .. } => forward,
        Projection::Perspective { .. } => (view.grid.center() - view.camera.eye)
            .try_normalize()
            .unwrap_or(forward),
    };
    let facing = view
        .grid
        .voxel_rows()
        .map(|row| row.normalize().dot(towards).abs());
    let largest = facing.into_iter().fold(0.0, f64::max);
    (0..3)
        .find(|&k| facing[k] >= largest - TIE)
        .expect("one of three is the largest")
}

/// Fills in the slice parameters for a part of the grid ([`View::part`]) in the stack along `axis`, and
/// returns how many slices to draw.
///
/// Rays that rise along the axis meet only slices above the eye, the others only slices below it. So both
/// sides are drawn towards (or away from) the eye one after the other, and every pixel has its order.
pub fn set_slices(
    view: &View,
    axis: usize,
    [low, high]: [DVec3; 2],
    fields: &mut FrameFields,
) -> u32 {
    let count = view.grid.dims[axis] as i32;
    let first = ((low[axis] - 0.5).ceil() as i32).clamp(0, count);
    let end = ((high[axis] - 0.5).floor() as i32 + 1).clamp(first, count);
    let above = first_slice_above_eye(view, axis).clamp(first, end);
    let (slices_above, slices_below) = (end - above, above - first);
    fields.slice_axis = axis as u32;
    // A slice that the eye lies in counts as below. It is the nearest of all: drawn last, or first.
    fields.slice_direction = -1;
    match view.settings.order {
        Order::BackToFront => {
            fields.slice_first = end - 1;
            fields.slice_turn = slices_above as u32;
            fields.slice_first_after_turn = first;
        }
        Order::FrontToBack => {
            fields.slice_first = above - 1;
            fields.slice_turn = slices_below as u32;
            fields.slice_first_after_turn = above;
        }
    }
    (slices_above + slices_below) as u32
}

/// The first slice whose centre lies above the eye along the axis.
fn first_slice_above_eye(view: &View, axis: usize) -> i32 {
    match view.camera.projection {
        Projection::Perspective { .. } => {
            let eye = view
                .grid
                .world_from_voxel
                .inverse()
                .transform_point3(view.camera.eye);
            // Outside i32 the cast goes to its ends, which is where such an eye is.
            (eye[axis] - 0.5).floor() as i32 + 1
        }
        // The eye is infinitely far below or above.
        Projection::Orthographic { .. } => {
            let rises = view.grid.voxel_rows()[axis].dot(view.rays().forward) > 0.0;
            if rises { i32::MIN } else { i32::MAX }
        }
    }
}
