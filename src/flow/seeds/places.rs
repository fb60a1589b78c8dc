//! Places by a rule that needs no field.
//!
//! ```text
//! part i of n    (i + 1/2) / n
//! ```

use super::pcg::unit;
use super::words::Axis;
use crate::volume::Grid;
use glam::DVec3;

/// The middle of a part.
fn middle(part: u32, of: u32) -> f64 {
    (f64::from(part) + 0.5) / f64::from(of)
}

/// The middles of so many equal parts of the grid's box along its axes, x fastest.
pub fn grid_seeds(grid: &Grid, counts: [u32; 3]) -> Vec<DVec3> {
    let [nx, ny, nz] = counts;
    let far = grid.far_corner();
    let place = |x: u32, y: u32, z: u32| {
        let part = DVec3::new(middle(x, nx), middle(y, ny), middle(z, nz));
        grid.world_from_voxel.transform_point3(part * far)
    };
    (0..nz)
        .flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| place(x, y, z))))
        .collect()
}

/// Places anywhere in the grid's box; another `seed` gives others.
pub fn random_seeds(grid: &Grid, count: u32, seed: u32) -> Vec<DVec3> {
    let far = grid.far_corner();
    let place = |i: u32| {
        let part = DVec3::from_array(unit(i, seed));
        grid.world_from_voxel.transform_point3(part * far)
    };
    (0..count).map(place).collect()
}

/// The middles of `count` times `count` equal parts of the plane where a coordinate of the world is `at`, within the world
/// box around the grid.
pub fn plane_seeds(grid: &Grid, axis: Axis, at: f64, count: u32) -> Vec<DVec3> {
    let far = grid.far_corner();
    let corners = (0..8_u32).map(|i| {
        let bit = |k: u32| f64::from(i >> k & 1);
        let corner = DVec3::new(bit(0), bit(1), bit(2)) * far;
        grid.world_from_voxel.transform_point3(corner)
    });
    let ends = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let [low, high] = corners.fold(ends, |[low, high], p| [low.min(p), high.max(p)]);
    let [k, i, j] = match axis {
        Axis::X => [0, 1, 2],
        Axis::Y => [1, 0, 2],
        Axis::Z => [2, 0, 1],
    };
    let place = |a: u32, b: u32| {
        let mut place = low;
        place[k] = at;
        place[i] += middle(a, count) * (high[i] - low[i]);
        place[j] += middle(b, count) * (high[j] - low[j]);
        place
    };
    (0..count)
        .flat_map(|b| (0..count).map(move |a| place(a, b)))
        .collect()
}

/// Places of the straight line between two, which are the first and the last; of a single one its middle.
pub fn rake_seeds(from: DVec3, to: DVec3, count: u32) -> Vec<DVec3> {
    let place = |i: u32| match count {
        1 => 0.5 * (from + to),
        _ => from + f64::from(i) / f64::from(count - 1) * (to - from),
    };
    (0..count).map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DAffine3, dvec3};

    fn grid() -> Grid {
        Grid {
            dims: [10, 20, 4],
            world_from_voxel: DAffine3::from_scale(dvec3(2.0, -1.0, 0.5)),
        }
    }

    #[test]
    fn places_are_where_their_rules_say() {
        let seeds = grid_seeds(&grid(), [2, 1, 2]);
        assert_eq!(
            seeds,
            [(5.0, 0.5), (15.0, 0.5), (5.0, 1.5), (15.0, 1.5)].map(|(x, z)| dvec3(x, -10.0, z))
        );
        let seeds = plane_seeds(&grid(), Axis::Y, -3.0, 2);
        assert_eq!(
            seeds,
            [(5.0, 0.5), (15.0, 0.5), (5.0, 1.5), (15.0, 1.5)].map(|(x, z)| dvec3(x, -3.0, z))
        );
        let seeds = rake_seeds(DVec3::ZERO, DVec3::ONE, 3);
        assert_eq!(seeds, [0.0, 0.5, 1.0].map(DVec3::splat));
        assert_eq!(rake_seeds(DVec3::ZERO, DVec3::ONE, 1), [DVec3::splat(0.5)]);
    }

    #[test]
    fn random_places_lie_in_the_box_and_another_number_gives_others() {
        let seeds = random_seeds(&grid(), 500, 3);
        let inside = |p: &DVec3| {
            let voxel = grid().world_from_voxel.inverse().transform_point3(*p);
            voxel.cmpge(DVec3::ZERO).all() && voxel.cmple(grid().far_corner()).all()
        };
        assert!(seeds.len() == 500 && seeds.iter().all(inside));
        assert_eq!(seeds, random_seeds(&grid(), 500, 3));
        assert_ne!(seeds, random_seeds(&grid(), 500, 4));
        // The mean of 500 is within four of its deviations of the middle.
        let mean = seeds.iter().sum::<DVec3>() / 500.0 - dvec3(10.0, -10.0, 1.0);
        let deviation = dvec3(20.0, 20.0, 2.0) / 12.0f64.sqrt() / 500.0f64.sqrt();
        assert!((mean / deviation).abs().max_element() < 4.0, "{mean}");
    }
}
