//! Straight paths from a node of the light grid, cut into the pieces that lie in one cell each (Amanatides and Woo,
//! "A Fast Voxel Traversal Algorithm for Ray Tracing", Eurographics 1987), and the directions that they have.
//!
//! Nodes are corners of cells: seen from any of them a path goes through the same pieces, and a surface that faces of
//! cells make has nodes on it.

use glam::DVec3;
use std::f64::consts::PI;

/// Paths all around: each has its opposite, and none lies in a plane of two world axes. So half of them end in a wall.
const AROUND: u32 = 32;
/// Paths to a light that is no point.
const TO_LIGHT: u32 = 8;
/// Turns between neighbours of a spiral that leaves no gaps: 1 - 1/golden ratio, in radians.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Unit vectors evenly over the sphere.
pub fn all_around() -> Vec<DVec3> {
    let half = AROUND / 2;
    let up = (0..half).map(|i| {
        let z = (f64::from(i) + 0.5) / f64::from(half);
        let turn = (f64::from(i) + 0.5) * GOLDEN_ANGLE;
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * turn.cos(), radius * turn.sin(), z)
    });
    up.flat_map(|way| [way, -way]).collect()
}

/// Unit vectors evenly over a disc that looks `size_degrees` wide, around the unit vector `way`.
pub fn towards(way: DVec3, size_degrees: f64) -> Vec<DVec3> {
    if size_degrees == 0.0 {
        return vec![way];
    }
    let (across, down) = way.any_orthonormal_pair();
    let edge = (0.5 * size_degrees * PI / 180.0).sin();
    let one = |i: u32| {
        let radius = edge * ((f64::from(i) + 0.5) / f64::from(TO_LIGHT)).sqrt();
        let turn = f64::from(i) * GOLDEN_ANGLE;
        let aside = radius * (turn.cos() * across + turn.sin() * down);
        aside + (1.0 - radius * radius).sqrt() * way
    };
    (0..TO_LIGHT).map(one).collect()
}

/// The pieces (cell relative to the node, world length) of the path along `slope`, cells per world length, that lie
/// between two distances from the node, as far as any node of a grid of so many cells needs them. A path along faces
/// of cells has more than one: one on each side.
pub fn path(slope: DVec3, reach: [f64; 2], cells: [u32; 3]) -> Vec<Vec<[f32; 4]>> {
    let steepest = slope.abs().max_element();
    let is_along = slope.to_array().map(|s| s.abs() < 1e-9 * steepest);
    let mut sides = vec![[0; 3]];
    for k in (0..3).filter(|&k| is_along[k]) {
        let other = |side: &[i32; 3]| {
            let mut side = *side;
            side[k] = -1;
            side
        };
        sides.extend(sides.iter().map(other).collect::<Vec<_>>());
    }
    let one = |side: [i32; 3]| pieces(slope.to_array(), is_along, side, reach, cells);
    sides.into_iter().map(one).collect()
}

fn pieces(
    slope: [f64; 3],
    is_along: [bool; 3],
    side: [i32; 3],
    [start, end]: [f64; 2],
    cells: [u32; 3],
) -> Vec<[f32; 4]> {
    let turns_back = |k: usize| slope[k] < 0.0 && !is_along[k];
    let mut cell: [i32; 3] = std::array::from_fn(|k| if turns_back(k) { -1 } else { side[k] });
    // Faces that have been crossed, and where the next one is.
    let mut crossed = [0.0; 3];
    let next = |crossed: [f64; 3]| -> [f64; 3] {
        std::array::from_fn(|k| match is_along[k] {
            true => f64::INFINITY,
            false => (crossed[k] + 1.0) / slope[k].abs(),
        })
    };
    let mut found = Vec::new();
    let mut at = 0.0;
    let is_near = |cell: [i32; 3]| (0..3).all(|k| cell[k].unsigned_abs() <= cells[k]);
    while at < end && is_near(cell) {
        let faces = next(crossed);
        let face = faces.into_iter().fold(f64::INFINITY, f64::min);
        let length = face.min(end) - at.max(start);
        // What rounding leaves of a path through an edge is no piece.
        if length > 1e-9 * face.min(end) {
            let [x, y, z] = cell.map(|n| n as f32);
            found.push([x, y, z, length as f32]);
        }
        for k in 0..3 {
            if faces[k] <= face * (1.0 + 1e-12) {
                crossed[k] += 1.0;
                cell[k] += if slope[k] < 0.0 { -1 } else { 1 };
            }
        }
        at = face;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    #[test]
    fn half_of_all_directions_lie_on_each_side_of_every_wall_and_none_in_it() {
        let all = all_around();
        assert_eq!(all.len(), AROUND as usize);
        for wall in [DVec3::X, DVec3::Y, DVec3::Z, dvec3(0.3, -0.5, 0.8)] {
            let above = all.iter().filter(|way| way.dot(wall) > 1e-6).count();
            let below = all.iter().filter(|way| way.dot(wall) < -1e-6).count();
            assert_eq!([above, below], [all.len() / 2; 2], "{wall}");
        }
        let mean = all.iter().map(|way| way.z * way.z).sum::<f64>() / all.len() as f64;
        assert!((mean - 1.0 / 3.0).abs() < 0.01, "{mean}");
    }

    #[test]
    fn the_pieces_of_a_path_are_together_as_long_as_it() {
        for slope in [
            dvec3(0.9, -0.4, 0.2),
            dvec3(-1.0, -1.0, -1.0),
            dvec3(0.1, 2.0, 0.7),
        ] {
            for sides in path(slope, [0.5, 6.25], [20; 3]) {
                let length: f32 = sides.iter().map(|piece| piece[3]).sum();
                assert!((length - 5.75).abs() < 1e-5, "{slope}: {length}");
                let cells = sides.windows(2).map(|pair| {
                    let steps = (0..3).map(|k| (pair[1][k] - pair[0][k]).abs());
                    steps.fold(0.0, f32::max)
                });
                assert!(cells.into_iter().all(|step| step == 1.0), "{slope} jumps");
            }
        }
    }

    #[test]
    fn a_path_along_an_axis_goes_on_all_four_sides_of_it() {
        let sides = path(dvec3(0.0, 0.0, -2.0), [0.0, f64::INFINITY], [3, 3, 2]);
        assert_eq!(sides.len(), 4);
        let cells = |side: usize| sides[side].iter().map(|&[x, y, z, _]| [x, y, z]);
        assert!(
            cells(0).eq([[0.0, 0.0, -1.0], [0.0, 0.0, -2.0]]),
            "{sides:?}"
        );
        assert!(
            sides.iter().flatten().all(|piece| piece[3] == 0.5),
            "{sides:?}"
        );
    }

    #[test]
    fn a_light_looks_as_wide_as_it_is_said_to_be() {
        let way = dvec3(1.0, 2.0, -0.5).normalize();
        assert_eq!(towards(way, 0.0), [way]);
        let disc = towards(way, 10.0);
        let widest = disc.iter().map(|one| one.angle_between(way).to_degrees());
        let widest = widest.fold(0.0, f64::max);
        assert!((4.5..=5.0).contains(&widest), "{widest}");
        assert!(disc.iter().all(|one| (one.length() - 1.0).abs() < 1e-12));
    }
}
