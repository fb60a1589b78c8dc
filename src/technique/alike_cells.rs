//! Which macro cells hold values that look alike: CPU reference of `shaders/macro_cells.wgsl` and of the last pass of
//! `shaders/distance_map.wgsl`, for linear and nearest filters.

use crate::real::Real;
use crate::shaders::CELL_VOXELS;
use crate::transfer::HomogeneousRanges;
use crate::volume::Volume;
use crate::volume::sample::nearest;

/// Voxels around a cell that samples in it touch, and half a one more.
const APRON: u32 = 1;

/// Macro cells of a whole volume.
#[derive(Clone, Debug)]
pub struct AlikeCells {
    cells: [u32; 3],
    is_alike: Vec<bool>,
}

impl AlikeCells {
    /// Of all voxels of a volume without holes.
    pub fn new(volume: &Volume, alike: &HomogeneousRanges) -> Self {
        let cells = volume.dims.map(|n| n.div_ceil(CELL_VOXELS));
        let [nx, ny, nz] = cells;
        let all = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
        let is_alike = all.map(|cell| alike.holds(range_of(volume, cell)));
        Self {
            cells,
            is_alike: is_alike.collect(),
        }
    }

    /// The cell that a position in voxel space lies in, where samples look alike.
    pub fn at<R: Real>(&self, position: [R; 3]) -> Option<usize> {
        let side = R::from_f64(f64::from(CELL_VOXELS));
        let cell: [usize; 3] = std::array::from_fn(|k| {
            let cell = (position[k] / side).floor().to_i32();
            cell.clamp(0, self.cells[k] as i32 - 1) as usize
        });
        let [nx, ny, _] = self.cells.map(|n| n as usize);
        let index = cell[0] + nx * (cell[1] + ny * cell[2]);
        self.is_alike[index].then_some(index)
    }
}

fn range_of(volume: &Volume, cell: [u32; 3]) -> [f32; 2] {
    let around = |k: usize| {
        let first = cell[k] * CELL_VOXELS;
        first.saturating_sub(APRON)..(first + CELL_VOXELS + APRON).min(volume.dims[k])
    };
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for z in around(2) {
        for y in around(1) {
            for x in around(0) {
                let center = [x, y, z].map(|n| f64::from(n) + 0.5);
                if let Some(value) = nearest(volume, center) {
                    (low, high) = (low.min(value), high.max(value));
                }
            }
        }
    }
    // To f32, outwards.
    [(low as f32).next_down(), (high as f32).next_up()]
}
