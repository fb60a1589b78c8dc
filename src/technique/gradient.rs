//! The gradient of the value at a sample: CPU reference of `shaders/lib/gradient.wgsl`.
//!
//! Central differences of the chosen filter one voxel before and after along each grid axis, and the chain rule
//! with voxel = A world:
//!
//! ```text
//! g_k = (f(p + e_k) - f(p - e_k)) / 2        gradient = A^T g = sum of g_k (row k of A)
//! ```
//!
//! Exact for a field that is quadratic along the grid axes, else off by the third derivative: of x^3 on a grid of
//! side h it is 3 x^2 + h^2 at voxel centres. With trilinear filtering it equals the interpolation of a volume of
//! central differences made beforehand, because both are linear in the voxels (`sampling.md` 7).

use crate::real::{Real, add, scale};
use crate::shaders::Frame;

/// Value per world length along each world axis, from the six taps: `tap` filters the volume so many voxels away
/// from the sample. Zero where one of them has no data.
pub fn gradient_of<R: Real>(frame: &Frame, tap: impl Fn([i32; 3]) -> Option<R>) -> [R; 3] {
    let none = [R::from_f64(0.0); 3];
    let mut gradient = none;
    for (axis, row) in frame.voxel_from_world.iter().enumerate() {
        let mut step = [0; 3];
        step[axis] = 1;
        let (Some(after), Some(before)) = (tap(step), tap(step.map(|n: i32| -n))) else {
            return none;
        };
        let difference = R::from_f64(0.5) * (after - before);
        let row = [row[0], row[1], row[2]].map(R::from_f32);
        gradient = add(gradient, scale(row, difference));
    }
    gradient
}
