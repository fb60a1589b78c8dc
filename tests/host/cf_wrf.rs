//! Levels that follow the ground on even heights, and winds from the faces of cells to their middles.
#![cfg(feature = "netcdf")]

use crate::fixtures;

use fixtures::{open, open_as, values};
use glam::DVec3;
use stratavox::volume::{Source, TimeComponent};

const FILE: &str = "netcdf/wrf.nc";

/// Thickness of the lowest layer at each time, m; the ground is at 128 m times the column's x.
const THICK: [f64; 2] = [256.0, 320.0];
/// Faces above the ground, in thicknesses.
const FACES: [f64; 5] = [0.0, 1.0, 3.0, 4.0, 8.0];

/// Each voxel of the first or second time: its x, its height in m and its value.
fn voxels(source: &dyn Source, time: u32) -> Vec<(u32, f64, Option<f64>)> {
    let header = source.header();
    let [nx, ny, nz] = header.dims;
    let values = values(source, TimeComponent { time, component: 0 });
    let mut found = Vec::new();
    for z in 0..nz {
        for _ in 0..ny {
            for x in 0..nx {
                let center = DVec3::new(f64::from(x), 0.0, f64::from(z)) + DVec3::splat(0.5);
                let height = 1000.0 * header.world_from_voxel.transform_point3(center).z;
                found.push((x, height, values[found.len()]));
            }
        }
    }
    found
}

#[test]
fn a_field_that_is_linear_in_height_stays_so_and_the_ground_holds_no_data() {
    let middles: Vec<f64> = FACES
        .windows(2)
        .map(|pair| 0.5 * (pair[0] + pair[1]))
        .collect();
    for (variable, levels, slope_x) in [("T", middles, 1000.0), ("W", FACES.to_vec(), 0.0)] {
        let source = open_as(FILE, Some(variable), false).unwrap();
        assert!(source.header().is_earth);
        let [nx, ny, nz] = source.header().dims;
        assert_eq!((nx, ny), (5, 3));
        assert!(nz as usize > levels.len(), "{nz}");
        for time in [0, 1] {
            let (mut inside, mut outside) = (0, 0);
            for (x, height, value) in voxels(source.as_ref(), time) {
                let ends = [levels[0], levels[levels.len() - 1]]
                    .map(|level| 128.0 * f64::from(x) + THICK[time as usize] * level);
                // Heights are f32 kilometres: nearer to an end than this, either side is right.
                let room = 1e-3;
                if ends.iter().any(|end| (height - end).abs() < room) {
                    continue;
                }
                if height < ends[0] || height > ends[1] {
                    assert_eq!(value, None, "{variable} at {x}, {height} m");
                    outside += 1;
                } else {
                    let wanted = height + slope_x * f64::from(x);
                    let found = value.expect("inside the column");
                    assert!(
                        (found - wanted).abs() < room,
                        "{variable}: {found}, not {wanted}"
                    );
                    inside += 1;
                }
            }
            assert!(
                inside > 30 && outside > 10,
                "{inside} inside, {outside} outside"
            );
        }
    }
}

#[test]
fn winds_come_to_the_middle_of_cells() {
    for (variable, stored, wanted) in [("U", [6, 3, 4], 2.0), ("V", [5, 4, 4], 2.0)] {
        let source = open(FILE, Some(variable)).unwrap();
        assert_eq!(source.header().dims, stored, "{variable}");
        let drawn = open_as(FILE, Some(variable), false).unwrap();
        assert_eq!(drawn.header().dims[..2], [5, 3], "{variable}");
        let values = values(drawn.as_ref(), TimeComponent::default());
        let mut valid = 0;
        for (i, value) in values.iter().enumerate() {
            let (x, y) = (i % 5, i / 5 % 3);
            let along = if variable == "U" { x } else { y };
            if let Some(value) = value {
                assert_eq!(*value, 4.0 * along as f64 + wanted, "{variable} at {x} {y}");
                valid += 1;
            }
        }
        assert!(valid > 30, "{valid}");
    }
}

#[test]
fn the_domain_stands_around_the_origin_and_times_have_their_dates() {
    for (variable, as_stored, ends) in [
        ("T", true, [-4.0, 4.0, -3.0, 3.0]),
        ("T", false, [-4.0, 4.0, -3.0, 3.0]),
        ("U", true, [-5.0, 5.0, -3.0, 3.0]),
        ("U", false, [-4.0, 4.0, -3.0, 3.0]),
        ("V", true, [-4.0, 4.0, -4.5, 4.5]),
    ] {
        let source = open_as(FILE, Some(variable), as_stored).unwrap();
        let header = source.header();
        let [nx, ny, _] = header.dims.map(f64::from);
        let first = header.world_from_voxel.transform_point3(DVec3::splat(0.5));
        let last = DVec3::new(nx - 0.5, ny - 0.5, 0.5);
        let last = header.world_from_voxel.transform_point3(last);
        assert_eq!(
            [first.x, last.x, first.y, last.y],
            ends,
            "{variable} {as_stored}"
        );
        let names = ["2005-08-28T12:00:00", "2005-08-28T15:00:00"];
        assert_eq!(header.time_names, names);
    }
    let names = open(FILE, Some("T")).unwrap().header().variables.clone();
    assert_eq!(names, ["T", "PHB", "PH", "W", "U", "V"]);
}
