//! How a grid is cut into bricks that a device can hold, and in which order bricks are drawn.
//!
//! The cut is regular: n bricks along an axis, each of ceil(dim / n) voxels, the last one smaller. A brick
//! also stores a halo of voxels around its own, so that filters and gradients find their neighbours.

use super::TextureLayout;
use crate::volume::VoxelBox;

/// One brick of a cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// Its place among the bricks, along x, y, z.
    pub index: [u32; 3],
    /// The voxels that are its own.
    pub own: VoxelBox,
    /// Its own voxels and the halo.
    pub stored: VoxelBox,
}

impl Cell {
    /// All of a volume.
    pub fn whole(dims: [u32; 3]) -> Self {
        let all = VoxelBox {
            min: [0; 3],
            max: dims,
        };
        Self {
            index: [0; 3],
            own: all,
            stored: all,
        }
    }
}

/// The fewest bricks whose stored voxels fit; `None` where not even single voxels do. `halo` says how many
/// neighbours are needed on either side along each axis.
pub fn cut(dims: [u32; 3], halo: [u32; 3], fits: impl Fn([u32; 3]) -> bool) -> Option<Vec<Cell>> {
    let mut counts = [1; 3];
    loop {
        let size: [u32; 3] = std::array::from_fn(|k| dims[k].div_ceil(counts[k]));
        let stored = std::array::from_fn(|k| {
            let margin = if counts[k] > 1 { 2 * halo[k] } else { 0 };
            (size[k] + margin).min(dims[k])
        });
        if fits(stored) {
            return Some(cells(dims, size, halo));
        }
        let longest = (0..3).max_by_key(|&k| size[k]).filter(|&k| size[k] > 1)?;
        // At least one voxel less along the longest side.
        counts[longest] = dims[longest]
            .div_ceil(size[longest] - 1)
            .max(counts[longest] + 1);
    }
}

/// Bricks of `side` voxels along each axis, the last ones smaller, with the halo of 3D textures.
pub fn cells_of_side(dims: [u32; 3], side: u32) -> Vec<Cell> {
    cells(
        dims,
        dims.map(|n| n.min(side)),
        TextureLayout::Texture3d.halo(),
    )
}

fn cells(dims: [u32; 3], size: [u32; 3], halo: [u32; 3]) -> Vec<Cell> {
    let counts: [u32; 3] = std::array::from_fn(|k| dims[k].div_ceil(size[k]));
    let [nx, ny, nz] = counts;
    let indices = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
    indices
        .map(|index| {
            let min: [u32; 3] = std::array::from_fn(|k| index[k] * size[k]);
            let max = std::array::from_fn(|k| (min[k] + size[k]).min(dims[k]));
            let stored = VoxelBox {
                min: std::array::from_fn(|k| min[k].saturating_sub(halo[k])),
                max: std::array::from_fn(|k| (max[k] + halo[k]).min(dims[k])),
            };
            Cell {
                index,
                own: VoxelBox { min, max },
                stored,
            }
        })
        .collect()
}

/// Bricks in the order in which every ray from the eye meets them: along a ray no axis ever steps back
/// towards the eye, so the number of steps from the eye's own cell rises (a regular grid has no cycles).
///
/// `eye_cell` is where the eye lies, in cells; infinite coordinates stand for parallel rays that come from
/// there.
pub fn front_to_back(cells: &[Cell], eye_cell: [f64; 3]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..cells.len()).collect();
    sort_front_to_back(&mut order, |i| &cells[i], eye_cell);
    order
}

/// The same of bricks that are there already, by their numbers: nothing is allocated.
pub(crate) fn sort_front_to_back<'a>(
    order: &mut [usize],
    cell: impl Fn(usize) -> &'a Cell,
    eye_cell: [f64; 3],
) {
    let steps = |cell: &Cell| -> u64 {
        (0..3)
            .map(|k| steps_along(cell.index[k], eye_cell[k]))
            .sum()
    };
    // Of equal ones the lower number first.
    order.sort_unstable_by_key(|&i| (steps(cell(i)), i));
}

/// The same, neighbours along x one after the other: along a ray none of the three numbers of steps falls.
pub fn front_to_back_by_rows(cells: &[Cell], eye_cell: [f64; 3]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..cells.len()).collect();
    let steps = |k: usize, cell: &Cell| steps_along(cell.index[k], eye_cell[k]);
    order.sort_by_key(|&i| [2, 1, 0].map(|k| steps(k, &cells[i])));
    order
}

fn steps_along(index: u32, eye: f64) -> u64 {
    // Farther away than any grid is long, the exact place does not matter.
    const FAR: f64 = u32::MAX as f64;
    let eye = eye.floor().clamp(-FAR, 2.0 * FAR);
    (f64::from(index) - eye).abs() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_voxel_belongs_to_one_brick_and_has_its_neighbours() {
        let dims = [23, 9, 40];
        let cells = cut(dims, [1, 2, 3], |stored| stored.iter().all(|&n| n <= 12)).unwrap();
        let own: u64 = cells
            .iter()
            .map(|c| c.own.dims().iter().map(|&n| u64::from(n)).product::<u64>())
            .sum();
        assert_eq!(own, 23 * 9 * 40, "own voxels of all bricks");
        for cell in &cells {
            for (k, dim) in dims.into_iter().enumerate() {
                let (own, stored, halo) = (cell.own, cell.stored, k as u32 + 1);
                assert!(stored.dims()[k] <= 12, "{cell:?} is too large");
                assert_eq!(stored.min[k], own.min[k].saturating_sub(halo), "{cell:?}");
                assert_eq!(stored.max[k], (own.max[k] + halo).min(dim), "{cell:?}");
            }
        }
    }

    #[test]
    fn what_fits_stays_in_one_piece() {
        let cells = cut([5, 6, 7], [1; 3], |_| true).unwrap();
        assert_eq!(cells.len(), 1);
        assert_eq!(cells[0].own, cells[0].stored);
        assert_eq!(cut([5, 6, 7], [1; 3], |_| false), None, "nothing fits");
    }

    #[test]
    fn a_ray_meets_bricks_in_their_order() {
        let cells = cut([40, 40, 40], [1; 3], |stored| {
            stored.iter().all(|&n| n <= 12)
        })
        .unwrap();
        let size = f64::from(cells[0].own.dims()[0]);
        let eyes = [[-3.0, 55.0, 7.0], [12.0, 13.0, 14.0], [21.0, -100.0, 90.0]];
        let orders = [front_to_back, front_to_back_by_rows];
        for (eye, order) in eyes.iter().flat_map(|eye| orders.map(|order| (eye, order))) {
            let order = order(&cells, eye.map(|e: f64| e / size));
            let rank = |p: [f64; 3]| {
                let index = p.map(|x| (x / size).floor() as u32);
                order.iter().position(|&i| cells[i].index == index)
            };
            for direction in [
                [0.3, -0.5, 0.2],
                [-0.1, 0.7, 0.6],
                [0.9, 0.05, -0.4],
                [0.01, 0.02, 1.0],
            ] {
                let mut last = 0;
                for step in 0..4000 {
                    let p: [f64; 3] =
                        std::array::from_fn(|k| eye[k] + 0.05 * f64::from(step) * direction[k]);
                    if p.iter().any(|&x| !(0.0..40.0).contains(&x)) {
                        continue;
                    }
                    let now = rank(p).unwrap();
                    assert!(
                        now >= last,
                        "from {eye:?} along {direction:?}: brick {now} after {last}"
                    );
                    last = now;
                }
            }
        }
    }
}
