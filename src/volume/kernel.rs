//! Kernels over three or four voxels of each axis: what the shaders' fetches give, function by function.
//!
//! With p in voxel space (centers at +0.5), clamped to the outermost centers first:
//!
//! ```text
//! p' = clamp(p, 1/2, dims - 1/2)           g = 1 - f
//!
//! quadratic B-spline   b = p',        i = floor(b), f = b - i, taps i-1 .. i+1
//!                      g^2/2,  1/2 + f g,  f^2/2
//! cubic B-spline       b = p' - 1/2,  i = floor(b), f = b - i, taps i-1 .. i+2
//!                      g^3/6,  2/3 - f^2 (2 - f)/2,  2/3 - g^2 (2 - g)/2,  f^3/6
//! Catmull-Rom          as cubic
//!                      -f g^2/2,  1 + f^2 (3f - 5)/2,  1 + g^2 (3g - 5)/2,  -f^2 g/2
//! ```
//!
//! Unser, "Splines: A Perfect Fit for Signal and Image Processing", IEEE Signal Processing Magazine 1999;
//! Catmull, Rom, "A Class of Local Interpolating Splines", 1974. A tap outside of the grid has the number of the
//! edge. CPU reference of `shaders/lib/kernel.wgsl` and of the files that import it.

use super::Volume;
use super::sample::{clamped, fetch, rescaled};
use crate::real::Real;

/// How neighbours are weighted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kernel {
    /// Quadratic B-spline, 27 voxels: continuous slope, never negative.
    Quadratic,
    /// Cubic B-spline, 64 voxels: continuous curvature, never negative.
    Cubic,
    /// 64 voxels: through the voxels as they are, with negative weights.
    CatmullRom,
}

/// What one axis contributes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taps<R> {
    /// The voxel of the first weight, perhaps outside of the grid.
    pub first: i32,
    /// One a voxel; the last of [`Kernel::Quadratic`] is 0.
    pub weights: [R; 4],
    /// First and last weight that is not zero in exact numbers.
    pub support: [usize; 2],
}

impl Kernel {
    /// The weights at fraction `f` from 0 to 1. Their sum is 1.
    pub fn weights<R: Real>(self, f: R) -> [R; 4] {
        let n = R::from_f64;
        let (half, one, two) = (n(0.5), n(1.0), n(2.0));
        let g = one - f;
        match self {
            Self::Quadratic => [half * g * g, half + f * g, half * f * f, n(0.0)],
            Self::Cubic => {
                let sixth = one / n(6.0);
                let middle = |f: R| two / n(3.0) - half * f * f * (two - f);
                [sixth * g * g * g, middle(f), middle(g), sixth * f * f * f]
            }
            Self::CatmullRom => {
                let outer = |f: R, g: R| -(half * f * g * g);
                let inner = |f: R| one + half * f * f * (n(3.0) * f - n(5.0));
                [outer(f, g), inner(f), inner(g), outer(g, f)]
            }
        }
    }

    /// The taps at coordinate `p` of an axis of `dim` voxels.
    pub fn taps<R: Real>(self, p: R, dim: u32) -> Taps<R> {
        let half = R::from_f64(0.5);
        let last = R::from_f64(f64::from(dim)) - half;
        let mut base = p.max(half).min(last);
        if self != Self::Quadratic {
            base = base - half;
        }
        let i = base.floor();
        let f = base - i;
        Taps {
            first: i.to_i32() - 1,
            weights: self.weights(f),
            support: self.support(f > R::from_f64(0.0)),
        }
    }

    /// At a fraction of 0 the outermost weights vanish.
    fn support(self, is_between: bool) -> [usize; 2] {
        match (self, is_between) {
            (Self::Quadratic, true) => [0, 2],
            (Self::Quadratic, false) => [0, 1],
            (Self::Cubic | Self::CatmullRom, true) => [0, 3],
            (Self::Cubic, false) => [0, 2],
            (Self::CatmullRom, false) => [1, 1],
        }
    }
}

impl<R: Real> Taps<R> {
    /// All the weight on one voxel.
    fn only(voxel: u32) -> Self {
        let (zero, one) = (R::from_f64(0.0), R::from_f64(1.0));
        Self {
            first: voxel as i32,
            weights: [one, zero, zero, zero],
            support: [0; 2],
        }
    }

    fn has_weight(&self, tap: usize) -> bool {
        (self.support[0]..=self.support[1]).contains(&tap)
    }

    fn voxel(&self, tap: usize, dim: u32) -> u32 {
        clamped(self.first.saturating_add(tap as i32), dim)
    }
}

/// The value at `p`; `None` is no data.
pub fn convolved<R: Real>(volume: &Volume, kernel: Kernel, p: [R; 3]) -> Option<R> {
    weighted(
        volume,
        std::array::from_fn(|k| kernel.taps(p[k], volume.dims[k])),
    )
}

/// The value at `p` inside slice `slice` of axis `axis`, of that slice's voxels alone; `p[axis]` is not looked at.
pub fn convolved_in_slice<R: Real>(
    volume: &Volume,
    kernel: Kernel,
    axis: usize,
    slice: u32,
    p: [R; 3],
) -> Option<R> {
    let taps = std::array::from_fn(|k| match k == axis {
        true => Taps::only(slice.min(volume.dims[axis] - 1)),
        false => kernel.taps(p[k], volume.dims[k]),
    });
    weighted(volume, taps)
}

fn weighted<R: Real>(volume: &Volume, [tx, ty, tz]: [Taps<R>; 3]) -> Option<R> {
    let [nx, ny, nz] = volume.dims;
    let mut sum = R::from_f64(0.0);
    for z in 0..4 {
        let mut plane = R::from_f64(0.0);
        for y in 0..4 {
            let mut row = R::from_f64(0.0);
            for x in 0..4 {
                if !(tx.has_weight(x) && ty.has_weight(y) && tz.has_weight(z)) {
                    continue;
                }
                let voxel = [tx.voxel(x, nx), ty.voxel(y, ny), tz.voxel(z, nz)];
                let (code, valid) = fetch(volume, voxel);
                if !valid {
                    return None;
                }
                row = row + tx.weights[x] * R::from_f32(code);
            }
            plane = plane + ty.weights[y] * row;
        }
        sum = sum + tz.weights[z] * plane;
    }
    Some(rescaled(volume, sum))
}
