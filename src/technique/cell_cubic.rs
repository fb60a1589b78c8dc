//! The trilinear field along a ray in a cell between eight voxel centres: CPU reference of `shaders/lib/cell_cubic.wgsl`.
//!
//! ```text
//! f(s) = A0 + A1 s + A2 s^2 + A3 s^3
//! ```

use crate::real::Real;

/// Of values at the corners, x first, then y, then z, at a part of the way along each axis.
pub(super) fn mixed<R: Real>(corners: &[R; 8], [x, y, z]: [R; 3]) -> R {
    let row = |i: usize| corners[i].lerp(corners[i + 1], x);
    row(0).lerp(row(2), y).lerp(row(4).lerp(row(6), y), z)
}

/// A0, A1, A2 and 3 A3.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cubic<R>(pub [R; 4]);

impl<R: Real> Cubic<R> {
    /// Along a ray that is at `p` of the cell where it enters.
    pub fn along(c: &[R; 8], p: [R; 3], d: [R; 3]) -> Self {
        // f = k + kx x + ky y + kz z + kxy x y + kyz y z + kzx z x + kxyz x y z
        let (kx, ky, kz) = (c[1] - c[0], c[2] - c[0], c[4] - c[0]);
        let (kxy, kzx) = (c[3] - c[2] - kx, c[5] - c[4] - kx);
        let kyz = c[6] - c[4] - ky;
        let kxyz = c[7] - c[6] - (c[5] - c[4]) - kxy;
        let a1 = kx * d[0]
            + ky * d[1]
            + kz * d[2]
            + kxy * (p[0] * d[1] + p[1] * d[0])
            + kyz * (p[1] * d[2] + p[2] * d[1])
            + kzx * (p[2] * d[0] + p[0] * d[2])
            + kxyz * (p[0] * p[1] * d[2] + p[1] * p[2] * d[0] + p[2] * p[0] * d[1]);
        let a2 = kxy * d[0] * d[1]
            + kyz * d[1] * d[2]
            + kzx * d[2] * d[0]
            + kxyz * (p[0] * d[1] * d[2] + p[1] * d[2] * d[0] + p[2] * d[0] * d[1]);
        let a3 = R::from_f64(3.0) * kxyz * d[0] * d[1] * d[2];
        Self([mixed(c, p), a1, a2, a3])
    }

    /// The value so far from where the ray enters.
    pub fn at(self, s: R) -> R {
        let Self([a0, a1, a2, a3]) = self;
        a0 + s * (a1 + s * (a2 + s * (a3 / R::from_f64(3.0))))
    }

    /// Where the derivative is zero, from where the ray enters; -1 where it is not.
    pub fn extremes(self) -> [R; 2] {
        let Self([_, a1, a2, a3]) = self;
        let zero = R::from_f64(0.0);
        let none = R::from_f64(-1.0);
        let inside = a2 * a2 - a3 * a1;
        if inside < zero {
            return [none; 2];
        }
        // The sum of equal signs: nothing cancels.
        let root = inside.sqrt();
        let sum = -(a2 + if a2 >= zero { root } else { -root });
        [
            if sum == zero { none } else { a1 / sum },
            if a3 == zero { none } else { sum / a3 },
        ]
    }
}
