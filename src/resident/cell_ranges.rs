//! Ranges of macro cells from voxels in memory, where the device is a program on the same processor: vectors of a row
//! are compared there, and texels fetched one by one here cost forty times as much (`docs/log/performance.md`). CPU reference of
//! `shaders/macro_cells.wgsl`, bit by bit.

use crate::shaders::{CELL_VOXELS, CellGrid};
use crate::volume::{VoxelBox, VoxelPart, Voxels};
use half::f16;

/// Cells of a grid: from `min` to before `max` along each axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CellBox {
    pub min: [u32; 3],
    pub max: [u32; 3],
}

impl CellBox {
    /// All of them.
    pub fn whole(grid: &CellGrid) -> Self {
        Self {
            min: [0; 3],
            max: grid.cells,
        }
    }

    /// Those that look at voxels of `region`; `None` where the grid does not hold any.
    pub fn that_see(grid: &CellGrid, region: VoxelBox) -> Option<Self> {
        let stored = VoxelBox {
            min: grid.stored_min.map(|n| n as u32),
            max: grid.stored_last.map(|n| n as u32 + 1),
        };
        let seen = region.and(&stored)?;
        // Cell c looks at voxels from origin + 8 c - halo to origin + 8 c + 7 + halo.
        let side = CELL_VOXELS as i32;
        let cell = |voxel: i32, axis: usize| {
            let last = grid.cells[axis] as i32 - 1;
            (voxel - grid.origin[axis]).div_euclid(side).clamp(0, last) as u32
        };
        let at = |voxel: u32, beyond: i32, axis: usize| cell(voxel as i32 + beyond, axis);
        Some(Self {
            min: std::array::from_fn(|k| at(seen.min[k], -grid.halo, k)),
            max: std::array::from_fn(|k| at(seen.max[k] - 1, grid.halo, k) + 1),
        })
    }

    /// The voxels that they look at: their own and the halo, as far as the brick stores them.
    pub fn looks_at(self, grid: &CellGrid) -> VoxelBox {
        let side = CELL_VOXELS as i32;
        let first = |k: usize| grid.origin[k] + self.min[k] as i32 * side - grid.halo;
        let end = |k: usize| grid.origin[k] + self.max[k] as i32 * side + grid.halo;
        VoxelBox {
            min: std::array::from_fn(|k| first(k).max(grid.stored_min[k]) as u32),
            max: std::array::from_fn(|k| end(k).min(grid.stored_last[k] + 1) as u32),
        }
    }
}

/// Smallest and largest value of some cells of a grid, x fastest, from what they look at.
pub(super) fn ranges(part: &VoxelPart, grid: &CellGrid, cells: CellBox) -> Vec<[f32; 2]> {
    let codes = match part.voxels {
        Voxels::U8(v) => code_ranges(v, part, grid, cells, |c| c.into()),
        Voxels::I8(v) => code_ranges(v, part, grid, cells, |c| c.into()),
        Voxels::U16(v) => code_ranges(v, part, grid, cells, |c| c.into()),
        Voxels::I16(v) => code_ranges(v, part, grid, cells, |c| c.into()),
        Voxels::F16(v) => code_ranges(v, part, grid, cells, f16::to_f32),
        Voxels::F32(v) => code_ranges(v, part, grid, cells, |c| c),
    };
    codes.into_iter().map(|ends| range_of(ends, grid)).collect()
}

/// The values that filters may make of codes between two ends.
pub(super) fn range_of(ends: [f32; 2], grid: &CellGrid) -> [f32; 2] {
    let [a, b] = ends.map(|code| code * grid.slope + grid.intercept);
    let error = SamplerError {
        slack: grid.slack,
        rounding: grid.rounding,
    };
    filtered([a.min(b), a.max(b)], grid.overshoot, error)
}

/// How far a device's sampler may be off.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SamplerError {
    /// In values.
    pub slack: f32,
    /// As a share of the larger value.
    pub rounding: f32,
}

/// The values that filters may make of those from `low` to `high`; `overshoot` is that of their [`Halo`](super::Halo).
pub(crate) fn filtered([low, high]: [f32; 2], overshoot: f32, error: SamplerError) -> [f32; 2] {
    let beyond =
        overshoot * 0.5 * (high - low) + error.slack + error.rounding * low.abs().max(high.abs());
    [low - beyond, high + beyond]
}

/// Smallest and largest code of each cell and its halo.
fn code_ranges<T: Copy + PartialOrd>(
    voxels: &[T],
    part: &VoxelPart,
    grid: &CellGrid,
    cells: CellBox,
    to_f32: impl Fn(T) -> f32,
) -> Vec<[f32; 2]> {
    // Of one row of cells along an axis.
    let along = |axis: usize, cell: u32| {
        let mut one = cells;
        (one.min[axis], one.max[axis]) = (cell, cell + 1);
        one.looks_at(grid)
    };
    let whole = cells.looks_at(grid);
    let length = (whole.max[0] - whole.min[0]) as usize;
    let mut found = Vec::new();
    for cz in cells.min[2]..cells.max[2] {
        for cy in cells.min[1]..cells.max[1] {
            // All rows of a row of cells at once, then the columns of each cell.
            let mut seen = along(1, cy);
            let deep = along(2, cz);
            (seen.min[2], seen.max[2]) = (deep.min[2], deep.max[2]);
            let mut rows = part.rows(seen).map(|first| &voxels[first..first + length]);
            let mut least = rows.next().expect("cells have voxels").to_vec();
            let mut most = least.clone();
            for row in rows {
                for ((least, most), &code) in least.iter_mut().zip(&mut most).zip(row) {
                    *least = if code < *least { code } else { *least };
                    *most = if code > *most { code } else { *most };
                }
            }
            for cx in cells.min[0]..cells.max[0] {
                let columns = along(0, cx);
                let [first, end] =
                    [columns.min[0], columns.max[0]].map(|x| (x - whole.min[0]) as usize);
                let ends = (first..end).fold([least[first], most[first]], |[low, high], x| {
                    [
                        if least[x] < low { least[x] } else { low },
                        if most[x] > high { most[x] } else { high },
                    ]
                });
                found.push(ends.map(&to_f32));
            }
        }
    }
    found
}
