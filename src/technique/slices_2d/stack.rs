//! Which slices of a stack are drawn, and in which order (`sampling.md` 3).

use super::planes_per_slice;
use crate::shaders::FrameFields;
use crate::technique::stack_axis::{facing, stack_axis};
use crate::technique::{Order, View};
use glam::DVec3;

impl View<'_> {
    /// How many slices (or planes between them) the longest stack has that is drawn.
    pub(in crate::technique) fn longest_stack(&self) -> f64 {
        let planes =
            |axis: usize| f64::from(self.grid.dims[axis]) * f64::from(planes_per_slice(self, axis));
        planes(stack_axis(self))
    }
}

/// Half the band, in degrees of the eye's way, in which both stacks are seen.
pub const BAND_DEGREES: f64 = 6.0;

/// The stacks whose pictures together are the picture, with the share of each; only smooth pictures have more than
/// one. Whatever the shares, they change without a jump where the eye goes.
///
/// With theta_k the angle between the eye's direction and the normal of stack k, and B the half band,
///
/// ```text
/// x_k = (theta_k - min theta) / (2 B)        r_k = 1 - x_k^2 (3 - 2 x_k), 0 from x_k = 1 on
/// share of stack k = r_k / (sum of r)
/// ```
///
/// At the switch both have one half; an angle B away from it one has all.
pub fn stack_shares(view: &View) -> Vec<(usize, f64)> {
    if !view.settings.smooth || view.settings.stack.is_some() {
        return vec![(stack_axis(view), 1.0)];
    }
    let angles = facing(view).map(|cosine| cosine.min(1.0).acos().to_degrees());
    let least = angles.into_iter().fold(f64::INFINITY, f64::min);
    let weights = angles.map(|angle| {
        let x = ((angle - least) / (2.0 * BAND_DEGREES)).min(1.0);
        1.0 - x * x * (3.0 - 2.0 * x)
    });
    let sum: f64 = weights.iter().sum();
    let shares = weights.into_iter().enumerate();
    let shares = shares.map(|(axis, weight)| (axis, weight / sum));
    shares.filter(|&(_, share)| share > 0.0).collect()
}

/// Fills in the slice parameters for a part of the grid ([`View::part`]) in the stack along `axis`, and
/// returns how many slices (or planes, or slabs between planes) to draw.
///
/// Rays that rise along the axis meet only slices above the eye, the others only slices below it. So both
/// sides are drawn towards (or away from) the eye one after the other, and every pixel has its order.
pub fn set_slices(
    view: &View,
    axis: usize,
    [low, high]: [DVec3; 2],
    fields: &mut FrameFields,
) -> u32 {
    let planes = f64::from(planes_per_slice(view, axis));
    let [low, high] = [low, high].map(|end| (end[axis] - 0.5) * planes);
    let [first, end] = if view.settings.preintegrated {
        // A slab is named by its lower plane; it counts where any of it does.
        [low.floor() as i32, high.ceil() as i32]
    } else {
        [low.ceil() as i32, high.floor() as i32 + 1]
    };
    let end = end.max(first);
    let above = first_plane_above_eye(view, axis, planes).clamp(first, end);
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

/// The first plane that lies above the eye along the axis.
fn first_plane_above_eye(view: &View, axis: usize, planes_per_slice: f64) -> i32 {
    match view.camera.projection.is_perspective() {
        true => {
            let eye = view
                .grid
                .world_from_voxel
                .inverse()
                .transform_point3(view.camera.eye);
            // Outside i32 the cast goes to its ends, which is where such an eye is.
            ((eye[axis] - 0.5) * planes_per_slice).floor() as i32 + 1
        }
        // The eye is infinitely far below or above.
        false => {
            let rises = view.grid.voxel_rows()[axis].dot(view.rays().forward) > 0.0;
            if rises { i32::MIN } else { i32::MAX }
        }
    }
}
