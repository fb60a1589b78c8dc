//! Distances known roughly beforehand, so that the expensive ones are worked out near their surface only.

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

#[cfg(test)]
mod tests {
    use super::super::{air, bone, skin, soft};
    use super::*;

    #[test]
    fn knowing_distances_roughly_changes_none_that_somebody_looks_at() {
        const REACH: f64 = 5.0;
        type Distance = fn(DVec3) -> f64;
        let bodies: [(&str, Distance); 5] = [
            ("skin", skin::distance),
            ("face", bone::face),
            ("jaw", bone::jaw),
            ("muscles", soft::muscles),
            ("air", |p| air::distance(p, 1.0)),
        ];
        for (name, distance) in bodies {
            let coarse = Coarse::new(REACH, distance);
            let mut left_out = 0;
            // A step that meets all parts of the cells.
            let along = |count: u32, from: f64| (0..count).map(move |k| from + 3.7 * f64::from(k));
            for x in along(32, 0.1) {
                for y in along(64, -119.8) {
                    for z in along(64, -119.7) {
                        let p = DVec3::new(x, y, z);
                        let (exact, found) = (distance(p), coarse.at(p, distance));
                        let both_far = exact.abs().min(found.abs()) > REACH
                            && exact.signum() == found.signum();
                        left_out += u32::from(found != exact);
                        assert!(
                            found == exact || both_far,
                            "{name} at {p}: {found}, not {exact}"
                        );
                    }
                }
            }
            assert!(left_out > 10_000, "{name}: {left_out} were left out");
        }
    }
}
