//! Which axis of the grid faces the eye (`sampling.md` 3): that of the stack that 2D slicing draws, that shear-warp casts
//! rays through, and whose slices are axis-aligned sheets of splats.
//!
//! The axis k of the largest |n_k . v|: n_k the normalized row k of `voxel_from_world`, v the unit vector
//! from the eye to the centre of the box (orthographic, or the eye at the centre: the forward vector). On
//! orthogonal grids that switches at 45 degrees; spacing does not weigh.

use super::View;

/// Two axes that face the eye alike by this much are a tie: the lower one wins.
const TIE: f64 = 1e-12;

/// The axis whose slices face the eye most, or the one that the settings name.
pub fn stack_axis(view: &View) -> usize {
    if let Some(axis) = view.settings.stack {
        return axis.min(2);
    }
    let facing = facing(view);
    let largest = facing.into_iter().fold(0.0, f64::max);
    (0..3)
        .find(|&k| facing[k] >= largest - TIE)
        .expect("one of three is the largest")
}

/// The two axes across axis `k`, in order.
pub(super) fn axes_across(k: usize) -> [usize; 2] {
    [[1, 2], [0, 2], [0, 1]][k]
}

/// |n_k . v| of each axis.
pub(super) fn facing(view: &View) -> [f64; 3] {
    let forward = view.rays().forward;
    let towards = match view.camera.projection.is_perspective() {
        false => forward,
        true => (view.grid.center() - view.camera.eye)
            .try_normalize()
            .unwrap_or(forward),
    };
    view.grid
        .voxel_rows()
        .map(|row| row.normalize().dot(towards).abs())
}
