//! Values between voxel centers: what the shaders' texel fetches give, function by function.
//!
//! With p in voxel space (centers at +0.5) and codes the stored numbers:
//!
//! ```text
//! nearest:  code[clamp(floor(p))]
//! linear:   q = p - 1/2,  i = floor(q),  f = q - i,  taps clamp(i + {0, 1}, 0, dims - 1)
//!           a + f (b - a) along x, then y, then z
//! value  =  code * slope + intercept
//! ```
//!
//! `None` is no data: a voxel of the footprint whose exact weight is not zero is invalid.

use super::Volume;
use crate::real::Real;

/// The value of the voxel that `p` lies in, or of the nearest one.
pub fn nearest<R: Real>(volume: &Volume, p: [R; 3]) -> Option<R> {
    let voxel = std::array::from_fn(|k| clamped(p[k].floor().to_i32(), volume.dims[k]));
    let (code, valid) = fetch(volume, voxel);
    valid.then(|| rescaled(volume, R::from_f32(code)))
}

/// The trilinear value at `p`.
pub fn linear<R: Real>(volume: &Volume, p: [R; 3]) -> Option<R> {
    interpolated(
        volume,
        std::array::from_fn(|k| Taps::new(p[k], volume.dims[k])),
    )
}

/// The bilinear value at `p` inside slice `slice` of axis `axis`; `p[axis]` is not looked at.
pub fn linear_in_slice<R: Real>(volume: &Volume, axis: usize, slice: u32, p: [R; 3]) -> Option<R> {
    let taps = std::array::from_fn(|k| match k == axis {
        true => Taps::only(slice.min(volume.dims[axis] - 1)),
        false => Taps::new(p[k], volume.dims[k]),
    });
    interpolated(volume, taps)
}

/// The two voxels of one axis and the weight of the second.
#[derive(Clone, Copy)]
struct Taps<R> {
    voxels: [u32; 2],
    fraction: R,
}

impl<R: Real> Taps<R> {
    fn new(p: R, dim: u32) -> Self {
        let q = p - R::from_f64(0.5);
        let i = q.floor();
        let first = i.to_i32();
        Self {
            voxels: [clamped(first, dim), clamped(first.saturating_add(1), dim)],
            fraction: q - i,
        }
    }

    fn only(voxel: u32) -> Self {
        Self {
            voxels: [voxel; 2],
            fraction: R::from_f64(0.0),
        }
    }

    /// Of the first and the second voxel. A fraction just under a whole number rounds to 1.
    fn has_weight(&self) -> [bool; 2] {
        [
            self.fraction < R::from_f64(1.0),
            self.fraction > R::from_f64(0.0),
        ]
    }
}

fn interpolated<R: Real>(volume: &Volume, taps: [Taps<R>; 3]) -> Option<R> {
    let weight = taps.map(|t| t.has_weight());
    let mut all_valid = true;
    let mut code = |x: usize, y: usize, z: usize| -> R {
        let voxel = [taps[0].voxels[x], taps[1].voxels[y], taps[2].voxels[z]];
        let (code, valid) = fetch(volume, voxel);
        all_valid &= valid || !(weight[0][x] && weight[1][y] && weight[2][z]);
        R::from_f32(code)
    };
    let mut row = |y, z| code(0, y, z).lerp(code(1, y, z), taps[0].fraction);
    let mut plane = |z| row(0, z).lerp(row(1, z), taps[1].fraction);
    let code = plane(0).lerp(plane(1), taps[2].fraction);
    all_valid
        .then(|| code * R::from_f64(volume.rescale.slope) + R::from_f64(volume.rescale.intercept))
}

pub(super) fn rescaled<R: Real>(volume: &Volume, code: R) -> R {
    code * R::from_f64(volume.rescale.slope) + R::from_f64(volume.rescale.intercept)
}

pub(super) fn clamped(voxel: i32, dim: u32) -> u32 {
    u32::try_from(voxel).unwrap_or(0).min(dim - 1)
}

/// The stored number of a voxel, and whether it is valid.
pub(super) fn fetch(volume: &Volume, [x, y, z]: [u32; 3]) -> (f32, bool) {
    let [nx, ny, _] = volume.dims.map(|n| n as usize);
    let index = (z as usize * ny + y as usize) * nx + x as usize;
    let valid = volume.validity.as_ref().is_none_or(|mask| mask[index] != 0);
    (volume.voxels.stored(index), valid)
}

/// The same of the voxel nearest to a place that may lie outside of the grid.
pub(crate) fn voxel_at(volume: &Volume, at: [i32; 3]) -> (f32, bool) {
    fetch(
        volume,
        std::array::from_fn(|k| clamped(at[k], volume.dims[k])),
    )
}
