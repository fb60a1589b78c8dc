//! How often each pair of value and gradient magnitude occurs: materials are blobs at its foot, and the
//! boundaries between them arches (Kindlmann & Durkin, Volume Visualization 1998).
//!
//! Central differences at voxel centres, with d_k the difference along voxel axis k:
//!
//! ```text
//! grad f = sum over k of d_k * (row k of the inverse of world_from_voxel)
//! ```
//!
//! exact for linear fields on any grid, sheared ones too. Where a neighbour is missing or holds no data the
//! difference is one-sided, without both it is 0.

use super::Volume;
use super::histogram::{Bins, edges};
use glam::DVec3;

/// Counts over value and gradient magnitude, voxels without data left out.
#[derive(Clone, Debug, PartialEq)]
pub struct JointHistogram {
    /// Values, after rescale, where the first column begins and the last one ends.
    pub value_range: [f64; 2],
    /// Values per world length where the first row begins (0) and the last one ends.
    pub gradient_range: [f64; 2],
    /// Columns, by ascending value; 0 where no voxel is valid.
    pub columns: usize,
    /// Rows, by ascending gradient magnitude.
    pub rows: usize,
    /// Row by row, the smallest gradients first.
    pub counts: Vec<u64>,
}

impl JointHistogram {
    /// Of the valid voxels of `volume`, in at most `max_columns` columns and in `rows` rows (at least one each).
    pub fn of(volume: &Volume, max_columns: usize, rows: usize) -> Self {
        let rows = rows.max(1);
        let Some(bins) = Bins::of_volume(volume, max_columns) else {
            return Self {
                value_range: [0.0; 2],
                gradient_range: [0.0; 2],
                columns: 0,
                rows,
                counts: Vec::new(),
            };
        };
        let gradients = Gradients::of(volume);
        let steepest = steepest_gradient(volume);
        // Where nothing changes any height would do.
        let top = if steepest > 0.0 { steepest } else { 1.0 };
        let columns = bins.len();
        let mut counts = vec![0; columns * rows];
        for (voxel, gradient) in gradients.each() {
            let row = ((gradient / top * rows as f64) as usize).min(rows - 1);
            let bin = bins.bin(volume.voxels.stored(voxel).into());
            let column = if volume.rescale.slope < 0.0 {
                columns - 1 - bin
            } else {
                bin
            };
            counts[row * columns + column] += 1;
        }
        Self {
            value_range: bins.value_range(volume.rescale),
            gradient_range: [0.0, top],
            columns,
            rows,
            counts,
        }
    }

    /// Where columns begin and end.
    pub fn value_edges(&self) -> Vec<f64> {
        edges(self.value_range, self.columns)
    }

    /// Where rows begin and end.
    pub fn gradient_edges(&self) -> Vec<f64> {
        edges(self.gradient_range, self.rows)
    }
}

/// The largest gradient magnitude of the valid voxels, in values per world length; 0 without one.
pub fn steepest_gradient(volume: &Volume) -> f64 {
    Gradients::of(volume)
        .each()
        .map(|(_, gradient)| gradient)
        .fold(0.0, f64::max)
}

/// The gradient magnitudes of a volume, made anew at each walk: kept, they would take as much as the voxels.
struct Gradients<'a> {
    volume: &'a Volume,
    rows: [DVec3; 3],
    strides: [usize; 3],
}

impl<'a> Gradients<'a> {
    fn of(volume: &'a Volume) -> Self {
        let [x, y, _] = volume.dims.map(|n| n as usize);
        Self {
            volume,
            rows: volume.grid().voxel_rows(),
            strides: [1, x, x * y],
        }
    }

    /// Index and gradient magnitude of each valid voxel.
    fn each(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let [x, y, z] = self.volume.dims;
        let places =
            (0..z).flat_map(move |k| (0..y).flat_map(move |j| (0..x).map(move |i| [i, j, k])));
        places
            .enumerate()
            .filter(|&(voxel, _)| self.is_valid(voxel))
            .map(|(voxel, place)| (voxel, self.magnitude(voxel, place)))
    }

    fn magnitude(&self, voxel: usize, place: [u32; 3]) -> f64 {
        let stored = |voxel: usize| f64::from(self.volume.voxels.stored(voxel));
        let gradient: DVec3 = (0..3)
            .map(|axis| {
                let stride = self.strides[axis];
                let before = (place[axis] > 0).then(|| voxel - stride);
                let after = (place[axis] + 1 < self.volume.dims[axis]).then(|| voxel + stride);
                let before = before.filter(|&voxel| self.is_valid(voxel));
                let after = after.filter(|&voxel| self.is_valid(voxel));
                let difference = match (before, after) {
                    (Some(before), Some(after)) => 0.5 * (stored(after) - stored(before)),
                    (Some(before), None) => stored(voxel) - stored(before),
                    (None, Some(after)) => stored(after) - stored(voxel),
                    (None, None) => 0.0,
                };
                difference * self.rows[axis]
            })
            .sum();
        gradient.length() * self.volume.rescale.slope.abs()
    }

    fn is_valid(&self, voxel: usize) -> bool {
        let validity = self.volume.validity.as_deref();
        validity.is_none_or(|mask| mask[voxel] != 0)
    }
}
