//! The gradient of the value at a sample: twin of `shaders/lib/gradient.wgsl`.
//!
//! Central differences of the chosen filter one voxel before and after along each grid axis, and the chain rule
//! with voxel = A world:
//!
//! ```text
//! g_k = (f(p + e_k) - f(p - e_k)) / 2        gradient = A^T g = sum of g_k (row k of A)
//! ```
//!
//! or Sobel's operator over the 26 voxels around, which smooths each difference across its axis by 1/4, 1/2, 1/4 (in
//! the plane: Sobel and Feldman 1968):
//!
//! ```text
//! g = sum of n 2^(-2 - |n_x| - |n_y| - |n_z|) f(p + n)        n in {-1, 0, 1}^3
//! ```
//!
//! Central differences are exact for a field that is quadratic along the grid axes, else off by the third derivative: of x^3 on a grid of
//! side h it is 3 x^2 + h^2 at voxel centres. With trilinear filtering it equals the interpolation of a volume of
//! central differences made beforehand, because both are linear in the voxels (`algorithms.md` T7).

use crate::real::{Real, add, scale};
use crate::shaders::{Frame, GRADIENT_CENTRAL, GRADIENT_SOBEL};

/// How the difference of values is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Stencil {
    /// Central differences one voxel before and after, along each grid axis.
    #[default]
    Central,
    /// Sobel's operator: smoother where voxels are noisy, and four times as many taps.
    Sobel,
}

impl Stencil {
    /// What the shaders call it.
    pub(super) fn number(self) -> u32 {
        match self {
            Self::Central => GRADIENT_CENTRAL,
            Self::Sobel => GRADIENT_SOBEL,
        }
    }
}

/// Value per world length along each world axis: `tap` filters the volume so many voxels away from the sample. Zero
/// where a tap has no data.
pub fn gradient_of<R: Real>(frame: &Frame, tap: impl Fn([i32; 3]) -> Option<R>) -> [R; 3] {
    let zero = R::from_f64(0.0);
    let found = if frame.gradient_stencil == GRADIENT_SOBEL {
        sobel(tap)
    } else {
        central(tap)
    };
    let Some(along_axes) = found else {
        return [zero; 3];
    };
    let rows = frame.voxel_from_world.map(|[x, y, z, _]| [x, y, z]);
    let parts = rows.into_iter().zip(along_axes);
    parts.fold([zero; 3], |sum, (row, part)| {
        add(sum, scale(row.map(R::from_f32), part))
    })
}

fn central<R: Real>(tap: impl Fn([i32; 3]) -> Option<R>) -> Option<[R; 3]> {
    let mut differences = [R::from_f64(0.0); 3];
    for (axis, difference) in differences.iter_mut().enumerate() {
        let mut step = [0; 3];
        step[axis] = 1;
        let after = tap(step)?;
        step[axis] = -1;
        *difference = R::from_f64(0.5) * (after - tap(step)?);
    }
    Some(differences)
}

fn sobel<R: Real>(tap: impl Fn([i32; 3]) -> Option<R>) -> Option<[R; 3]> {
    let mut sum = [R::from_f64(0.0); 3];
    for i in 0..27 {
        let step = [i % 3, i / 3 % 3, i / 9].map(|n: i32| n - 1);
        let around = step.iter().map(|n| n.abs()).sum::<i32>();
        if around == 0 {
            continue;
        }
        let weighted = R::from_f64(2f64.powi(-2 - around)) * tap(step)?;
        sum = add(sum, scale(step.map(|n| R::from_f64(n.into())), weighted));
    }
    Some(sum)
}
