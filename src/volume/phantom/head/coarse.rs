//! Distances known roughly beforehand, so that the dear ones are worked out near their surface only.

use super::HALF_SIDE;
use glam::DVec3;

/// Side of a cell.
const CELL: f64 = 6.0;
/// Cells along x (one half of the box) and along y and z.
const CELLS: [usize; 3] = [20, 40, 40];

/// A distance at the middle of each cell of the box.
pub(super) struct Coarse {
    distances: Vec<f32>,
    /// Farther off than this at the middle of a cell is far off in all of it.
    far: f64,
}

impl Coarse {
    /// `reach` is how far from a surface somebody wants to know the distance.
    pub fn new(reach: f64, distance: impl Fn(DVec3) -> f64) -> Self {
        let mut distances = Vec::with_capacity(CELLS.iter().product());
        for z in 0..CELLS[2] {
            for y in 0..CELLS[1] {
                for x in 0..CELLS[0] {
                    let middle = DVec3::new(x as f64, y as f64, z as f64) + 0.5;
                    let corner = DVec3::new(0.0, -HALF_SIDE, -HALF_SIDE);
                    distances.push(distance(corner + CELL * middle) as f32);
                }
            }
        }
        // Our distances grow by at most 1.5 a millimetre.
        let across_half_a_cell = 0.5 * CELL * 3f64.sqrt() * 1.5;
        Self {
            distances,
            far: reach + across_half_a_cell,
        }
    }

    /// `distance` at `p` where it is small; a number of its sign, larger than the reach, elsewhere.
    pub fn at(&self, p: DVec3, distance: impl Fn(DVec3) -> f64) -> f64 {
        let cell = (p + DVec3::new(0.0, HALF_SIDE, HALF_SIDE)) / CELL;
        let [x, y, z] = [cell.x as usize, cell.y as usize, cell.z as usize];
        let inside = x < CELLS[0] && y < CELLS[1] && z < CELLS[2];
        let rough = if inside {
            f64::from(self.distances[(z * CELLS[1] + y) * CELLS[0] + x])
        } else {
            0.0
        };
        if rough.abs() > self.far {
            rough
        } else {
            distance(p)
        }
    }
}
