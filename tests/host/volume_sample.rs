//! The samplers: exact where filtering is exact, and no data exactly where a weight meets a hole.

use glam::{DAffine3, DVec3};
use stratavox::real::Real;
use stratavox::volume::sample::{linear, linear_in_slice, nearest};
use stratavox::volume::{Rescale, Volume, Voxels};

const DIMS: [u32; 3] = [5, 4, 6];
const RESCALE: Rescale = Rescale {
    slope: 0.5,
    intercept: -3.0,
};

/// 1 + 3 x + 7 y + 2 z at the voxel (x, y, z), which an f32 holds exactly.
fn ramp(hole: Option<[usize; 3]>) -> Volume {
    let [nx, ny, nz] = DIMS.map(|n| n as usize);
    let mut numbers = Vec::new();
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                let number = (1 + 3 * x + 7 * y + 2 * z) as f32;
                numbers.push(if hole == Some([x, y, z]) {
                    f32::NAN
                } else {
                    number
                });
            }
        }
    }
    Volume::from_voxels(
        DIMS,
        DAffine3::IDENTITY,
        Voxels::F32(numbers),
        RESCALE,
        None,
    )
    .unwrap()
}

fn exact(p: DVec3) -> f64 {
    let clamped = (p - 0.5).clamp(
        DVec3::ZERO,
        DVec3::from_array(DIMS.map(|n| f64::from(n - 1))),
    );
    0.5 * (1.0 + clamped.dot(DVec3::new(3.0, 7.0, 2.0))) - 3.0
}

/// Points in and half a voxel around the grid; quarters of a voxel, which have exact weights.
fn points() -> impl Iterator<Item = DVec3> {
    let steps = DIMS.map(|n| 4 * n as i32 + 2);
    (-2..=steps[0]).flat_map(move |x| {
        (-2..=steps[1]).flat_map(move |y| {
            (-2..=steps[2]).map(move |z| DVec3::new(x.into(), y.into(), z.into()) * 0.25)
        })
    })
}

fn as_reals<R: Real>(p: DVec3) -> [R; 3] {
    p.to_array().map(R::from_f64)
}

#[test]
fn trilinear_filtering_reproduces_a_ramp_and_holds_its_edges() {
    let volume = ramp(None);
    for p in points() {
        // Quarters times small whole numbers: no rounding in either type.
        assert_eq!(
            linear::<f64>(&volume, as_reals(p)),
            Some(exact(p)),
            "at {p}"
        );
        assert_eq!(
            linear::<f32>(&volume, as_reals(p)).map(f64::from),
            Some(exact(p)),
            "at {p}"
        );
    }
}

#[test]
fn nearest_gives_the_voxel_that_the_point_lies_in() {
    let volume = ramp(None);
    for p in points() {
        let center = p.floor().clamp(
            DVec3::ZERO,
            DVec3::from_array(DIMS.map(|n| f64::from(n - 1))),
        ) + 0.5;
        assert_eq!(
            nearest::<f64>(&volume, as_reals(p)),
            Some(exact(center)),
            "at {p}"
        );
        assert_eq!(
            nearest::<f32>(&volume, as_reals(p)).map(f64::from),
            Some(exact(center)),
            "at {p}"
        );
    }
}

#[test]
fn a_sample_is_no_data_exactly_where_the_hole_has_a_weight() {
    for hole in [[2, 1, 3], [0, 0, 0], [4, 3, 5], [0, 2, 5]] {
        let volume = ramp(Some(hole));
        let mut missing = 0;
        for p in points() {
            let place = DVec3::from_array(hole.map(|k| k as f64));
            let last = DVec3::from_array(DIMS.map(|n| f64::from(n - 1)));
            let away = ((p - 0.5).clamp(DVec3::ZERO, last) - place).abs();
            let has_weight = away.max_element() < 1.0;
            let in_hole = p.floor().clamp(DVec3::ZERO, last) == place;
            missing += usize::from(has_weight);
            assert_eq!(
                linear::<f64>(&volume, as_reals(p)).is_none(),
                has_weight,
                "hole {hole:?}, at {p}"
            );
            assert_eq!(
                linear::<f32>(&volume, as_reals(p)).is_none(),
                has_weight,
                "hole {hole:?}, at {p}"
            );
            assert_eq!(
                nearest::<f64>(&volume, as_reals(p)).is_none(),
                in_hole,
                "hole {hole:?}, at {p}"
            );
        }
        assert!(missing > 0, "no point near the hole {hole:?}");
    }
}

#[test]
fn a_slice_is_filtered_within_itself() {
    let hole = [2, 1, 3];
    let volume = ramp(Some(hole));
    for axis in 0..3 {
        for slice in 0..DIMS[axis] {
            for mut p in points() {
                p[axis] = f64::from(slice) + 0.5;
                let inside = linear::<f64>(&volume, as_reals(p));
                // Wherever along the axis: the slice alone counts.
                p[axis] -= 0.3;
                let found = linear_in_slice::<f64>(&volume, axis, slice, as_reals(p));
                assert_eq!(found, inside, "slice {slice} of axis {axis}, at {p}");
            }
        }
    }
}

#[test]
fn a_point_just_short_of_a_center_still_needs_the_voxel_before() {
    let volume = ramp(Some([1, 1, 1]));
    assert_eq!(linear::<f32>(&volume, [2.5f32.next_down(), 1.5, 1.5]), None);
    assert!(linear::<f32>(&volume, [2.5, 1.5, 1.5]).is_some());
}

#[test]
fn points_far_away_and_points_that_are_none_do_not_break_the_samplers() {
    let volume = ramp(None);
    let last = exact(DVec3::splat(1e3));
    assert_eq!(linear::<f64>(&volume, [1e300; 3]), Some(last));
    assert_eq!(linear::<f32>(&volume, [1e30; 3]), Some(last as f32));
    assert_eq!(nearest::<f64>(&volume, [f64::INFINITY; 3]), Some(last));
    assert!(nearest::<f64>(&volume, [f64::NAN; 3]).is_some());
}
