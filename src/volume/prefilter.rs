//! Coefficients of the B-spline that goes through the voxels: what makes `quadratic` and `cubic` interpolate.
//!
//! A B-spline with the voxels as coefficients blurs. The coefficients c whose spline has the values v at the voxel
//! centres solve, along one axis after the other,
//!
//! ```text
//! quadratic  (c[i-1] + 6 c[i] + c[i+1]) / 8 = v[i]     pole z = 2 sqrt 2 - 3
//! cubic      (c[i-1] + 4 c[i] + c[i+1]) / 6 = v[i]     pole z = sqrt 3 - 2
//!
//! c+[i] = v[i] + z c+[i-1]                from the first on
//! c [i] = z (c[i+1] - c+[i])              from the last on, all times (1 - z)(1 - 1/z)
//! ```
//!
//! Unser, Aldroubi, Eden, "Fast B-Spline Transforms", IEEE PAMI 13, 1991. Ends: c[-1] = c[0] and c[n] = c[n-1], which
//! is what a fetch beyond the edge returns, and no spline between the outermost centres looks farther. It is the
//! same as going on with the values mirrored at the outer faces, so the sums of the recursion's start are known.

use super::kernel::Kernel;
use super::{Volume, Voxels};

/// A B-spline that goes through the voxels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Spline {
    Quadratic,
    Cubic,
}

impl Spline {
    /// The basis function.
    pub fn kernel(self) -> Kernel {
        match self {
            Self::Quadratic => Kernel::Quadratic,
            Self::Cubic => Kernel::Cubic,
        }
    }

    fn pole(self) -> f64 {
        match self {
            Self::Quadratic => 2.0 * 2.0_f64.sqrt() - 3.0,
            Self::Cubic => 3.0_f64.sqrt() - 2.0,
        }
    }
}

/// The coefficients of a volume's spline, as f32 whatever the voxels are, and in the voxels' place: rescale, holes,
/// range and all else are those of the volume, and `value_range` is that of its values.
#[derive(Clone, Debug)]
pub struct Coefficients {
    spline: Spline,
    axes: [bool; 3],
    volume: Volume,
}

impl Coefficients {
    /// Bytes of one voxel, a mask beside them left out.
    pub const BYTES_PER_VOXEL: u64 = size_of::<f32>() as u64;

    /// Of `volume`, along the `axes` that are filtered: all of them for a 3D texture, the two inside the slices for
    /// stacks. Holes count with the numbers that they are filled with.
    pub fn new(volume: &Volume, spline: Spline, axes: [bool; 3]) -> Self {
        let mut numbers: Vec<f32> = (0..volume.voxels.len())
            .map(|i| volume.voxels.stored(i))
            .collect();
        let [nx, ny, nz] = volume.dims.map(|n| n as usize);
        let pole = spline.pole();
        if axes[0] {
            for row in numbers.chunks_exact_mut(nx) {
                filter(row, 1, pole);
            }
        }
        if axes[1] {
            for slice in numbers.chunks_exact_mut(nx * ny) {
                filter(slice, nx, pole);
            }
        }
        if axes[2] {
            debug_assert_eq!(numbers.len(), nx * ny * nz);
            filter(&mut numbers, nx * ny, pole);
        }
        Self {
            spline,
            axes,
            volume: Volume {
                dims: volume.dims,
                world_from_voxel: volume.world_from_voxel,
                voxels: Voxels::F32(numbers),
                rescale: volume.rescale,
                validity: volume.validity.clone(),
                hounsfield: volume.hounsfield,
                unit: volume.unit.clone(),
                loss: volume.loss,
                value_range: volume.value_range,
            },
        }
    }

    /// What they are coefficients of.
    pub fn spline(&self) -> Spline {
        self.spline
    }

    /// The axes along which they are coefficients.
    pub fn axes(&self) -> [bool; 3] {
        self.axes
    }

    /// Coefficients where voxels would be.
    pub fn volume(&self) -> &Volume {
        &self.volume
    }
}

/// Columns that are filtered at once: neighbours in memory are read together.
const COLUMNS: usize = 64;

/// Filters the columns of `numbers`, which are `stride` in number and whose entries are `stride` apart.
fn filter(numbers: &mut [f32], stride: usize, pole: f64) {
    let n = numbers.len() / stride;
    let mut work = vec![0.0; n * COLUMNS.min(stride)];
    for first in (0..stride).step_by(COLUMNS) {
        let width = COLUMNS.min(stride - first);
        for i in 0..n {
            for u in 0..width {
                work[i * width + u] = f64::from(numbers[i * stride + first + u]);
            }
        }
        coefficients(&mut work[..n * width], width, pole);
        for i in 0..n {
            for u in 0..width {
                numbers[i * stride + first + u] = work[i * width + u] as f32;
            }
        }
    }
}

/// The same for `width` columns side by side, all of them at once.
fn coefficients(c: &mut [f64], width: usize, z: f64) {
    // |z|^TERMS is under 1e-22.
    const TERMS: usize = 40;
    let n = c.len() / width;
    // Mirrored at the outer faces, the values repeat after 2n.
    let mirrored = |i: usize| match i % (2 * n) {
        i if i < n => i,
        i => 2 * n - 1 - i,
    };
    let gain = (1.0 - z) * (1.0 - 1.0 / z);
    for u in 0..width {
        let before = |j: usize| c[mirrored(j - 1) * width + u];
        let start = (1..=TERMS).rev().fold(0.0, |sum, j| z * (before(j) + sum));
        c[u] = gain * (c[u] + start);
    }
    for i in 1..n {
        for u in 0..width {
            c[i * width + u] = gain * c[i * width + u] + z * c[(i - 1) * width + u];
        }
    }
    for u in 0..width {
        c[(n - 1) * width + u] *= z / (z - 1.0);
    }
    for i in (0..n - 1).rev() {
        for u in 0..width {
            c[i * width + u] = z * (c[(i + 1) * width + u] - c[i * width + u]);
        }
    }
}
