//! Ranges of macro cells from voxels in memory, where the device is a program on the same processor: vectors of a row are
//! compared there, and texels fetched one by one here cost forty times as much (`docs/performance.md`). Twin of
//! `shaders/macro_cells.wgsl`, bit by bit.

use crate::shaders::{CELL_VOXELS, CellGrid};
use crate::volume::{Volume, Voxels};
use half::f16;
use std::ops::RangeInclusive;

/// Smallest and largest value of each cell of a grid, x fastest. `corner` is the first voxel of `volume` in the grid.
pub(super) fn ranges(volume: &Volume, corner: [u32; 3], grid: &CellGrid) -> Vec<[f32; 2]> {
    let held = Held {
        dims: volume.dims.map(|n| n as usize),
        corner: corner.map(|n| n as usize),
    };
    let codes = match &volume.voxels {
        Voxels::U8(v) => code_ranges(v, &held, grid, |c| c.into()),
        Voxels::I8(v) => code_ranges(v, &held, grid, |c| c.into()),
        Voxels::U16(v) => code_ranges(v, &held, grid, |c| c.into()),
        Voxels::I16(v) => code_ranges(v, &held, grid, |c| c.into()),
        Voxels::F16(v) => code_ranges(v, &held, grid, f16::to_f32),
        Voxels::F32(v) => code_ranges(v, &held, grid, |c| c),
    };
    codes.into_iter().map(|ends| range_of(ends, grid)).collect()
}

/// The values that filters may make of codes between two ends.
fn range_of(ends: [f32; 2], grid: &CellGrid) -> [f32; 2] {
    let [a, b] = ends.map(|code| code * grid.slope + grid.intercept);
    let (low, high) = (a.min(b), a.max(b));
    let beyond = grid.overshoot * 0.5 * (high - low)
        + grid.slack
        + grid.rounding * low.abs().max(high.abs());
    [low - beyond, high + beyond]
}

/// Which voxels of the grid are in memory.
struct Held {
    dims: [usize; 3],
    corner: [usize; 3],
}

/// Smallest and largest code of each cell and its apron.
fn code_ranges<T: Copy + PartialOrd>(
    voxels: &[T],
    held: &Held,
    grid: &CellGrid,
    to_f32: impl Fn(T) -> f32,
) -> Vec<[f32; 2]> {
    let [nx, ny, _] = held.dims;
    // Voxels of the cells and the apron along an axis, as far as the brick stores them.
    let around = |axis: usize, cell: u32| -> RangeInclusive<usize> {
        let own = grid.origin[axis] + (cell * CELL_VOXELS) as i32;
        let last = own + CELL_VOXELS as i32 - 1 + grid.apron;
        let from = (own - grid.apron).max(grid.stored_min[axis]);
        let place = |voxel: i32| voxel as usize - held.corner[axis];
        place(from)..=place(last.min(grid.stored_last[axis]))
    };
    let mut found = Vec::with_capacity(grid.cells.iter().product::<u32>() as usize);
    for cz in 0..grid.cells[2] {
        for cy in 0..grid.cells[1] {
            // All rows of a layer of cells at once, then the columns of each cell.
            let rows = around(2, cz).flat_map(|z| around(1, cy).map(move |y| (z * ny + y) * nx));
            let mut rows = rows.map(|start| &voxels[start..start + nx]);
            let mut least = rows.next().expect("cells have voxels").to_vec();
            let mut most = least.clone();
            for row in rows {
                for ((least, most), &code) in least.iter_mut().zip(&mut most).zip(row) {
                    *least = if code < *least { code } else { *least };
                    *most = if code > *most { code } else { *most };
                }
            }
            for cx in 0..grid.cells[0] {
                let columns = around(0, cx);
                let first = *columns.start();
                let ends = columns.fold([least[first], most[first]], |[low, high], x| {
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
