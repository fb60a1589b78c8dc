//! Variables that are computed from others of a file, against MetPy and numpy (`tests/fixtures/netcdf/derived.py`).
#![cfg(feature = "netcdf")]

use crate::files;
use crate::fixtures;

use files::message;
use fixtures::{json, open, open_as, values};
use std::path::PathBuf;
use stratavox::volume::{Limits, MapKind, Source, TimeComponent, VolumeSelection, VoxelBox};

const WRF: &str = "netcdf/wrf_derived.nc";

/// A value is computed in f64 of f32 parts, which are exact, and rounded to f32 once: half a unit in its last place. Winds
/// of WRF are rounded in the middles of cells too, which changes their length by as much at most. The rest is for powers
/// and exponentials of another library.
fn allowed(value: f64, roundings: f64) -> f64 {
    value.abs() * (roundings * f64::from(f32::EPSILON) / 2.0 + 1e-12)
}

fn whole(source: &dyn Source, time: u32) -> Vec<Option<f64>> {
    values(source, TimeComponent { time, component: 0 })
}

#[test]
fn derived_values_are_those_of_an_independent_computation() {
    let expected = json("netcdf/derived.json");
    let mut compared = 0;
    for entry in expected.as_array().unwrap() {
        let word = |key: &str| entry[key].as_str().unwrap();
        let place = format!("{} {}", word("file"), word("variable"));
        let source = open(&format!("netcdf/{}", word("file")), Some(word("variable")))
            .unwrap_or_else(|e| panic!("{place}: {}", message(&e)));
        let header = source.header();
        assert_eq!(header.variables[0], word("variable"), "{place}");
        assert_eq!(header.unit.as_deref(), Some(word("unit")), "{place}");
        assert_eq!(serde_json::json!(header.dims), entry["dims"], "{place}");
        let is_centred = place == format!("{} wind_speed", &WRF[7..]);
        let roundings = if is_centred { 2.0 } else { 1.0 };
        let times = entry["times"].as_array().unwrap();
        assert_eq!(header.times as usize, times.len(), "{place}");
        for (time, wanted) in times.iter().enumerate() {
            let found = whole(source.as_ref(), time as u32);
            let wanted = wanted.as_array().unwrap();
            assert_eq!(found.len(), wanted.len(), "{place}");
            for (i, (found, wanted)) in found.iter().zip(wanted).enumerate() {
                match (found, wanted.as_f64()) {
                    (Some(found), Some(wanted)) => {
                        let off = (found - wanted).abs();
                        assert!(
                            off <= allowed(wanted, roundings),
                            "{place}, {i}: {found}, not {wanted}"
                        );
                        compared += 1;
                    }
                    (found, wanted) => assert_eq!(*found, wanted, "{place}, {i}"),
                }
            }
        }
    }
    assert!(compared > 1500, "{compared}");
}

#[test]
fn a_part_of_the_grid_is_that_part_of_the_whole() {
    let source = open(WRF, Some("relative_humidity")).unwrap();
    let [nx, ny, _] = source.header().dims;
    let all = whole(source.as_ref(), 1);
    let region = VoxelBox {
        min: [1, 2, 3],
        max: [4, 4, 5],
    };
    let pick = TimeComponent {
        time: 1,
        component: 0,
    };
    let part = source.read(pick, region).unwrap().voxels;
    let mut i = 0;
    for z in 3..5 {
        for y in 2..4 {
            for x in 1..4 {
                let index = (x + nx * (y + ny * z)) as usize;
                assert_eq!(Some(f64::from(part.stored(i))), all[index], "{x} {y} {z}");
                i += 1;
            }
        }
    }
}

#[test]
fn derived_variables_are_told_apart_and_a_variable_of_the_file_wins() {
    let names = |file: &str, first: &str| {
        let header = open(file, Some(first)).unwrap().header().clone();
        let derived = header.derived.into_iter().map(|v| v.name);
        (header.variables, derived.collect::<Vec<_>>())
    };
    let all = ["temperature", "pressure", "wind_speed", "relative_humidity"];
    let (variables, derived) = names(WRF, "T");
    assert_eq!(derived, all);
    assert!(!variables.iter().any(|name| all.contains(&name.as_str())));
    let (variables, _) = names(WRF, "temperature");
    assert_eq!(variables[..2], ["temperature", "T"]);
    let (_, derived) = names("netcdf/levels.nc", "t");
    assert_eq!(derived, ["temperature", "relative_humidity"]);
    // Levels have pressures, and the file has a variable of that name.
    let own = open("netcdf/levels.nc", Some("pressure")).unwrap();
    assert_eq!(whole(own.as_ref(), 0)[0], Some(7.0));
    assert!(
        open("netcdf/order.nc", None)
            .unwrap()
            .header()
            .derived
            .is_empty()
    );
}

#[test]
fn a_note_says_what_was_derived_from_what() {
    for (name, words) in [
        ("temperature", "(T + 300) ((P + PB) / 100000)^(2/7)"),
        ("wind_speed", "the length of the vector U, V, W"),
        ("relative_humidity", "T + 300, P + PB, QVAPOR"),
    ] {
        let source = open(WRF, Some(name)).unwrap();
        let notes = source.header().notes.join("; ");
        assert!(notes.contains(&format!("{name} is derived: ")), "{notes}");
        assert!(notes.contains(words), "{notes}");
    }
}

#[test]
fn missing_parts_are_refused_by_name() {
    for (file, variable, words) in [
        ("wrf.nc", "temperature", ["air_pressure", "PHB, PH, T, W"]),
        (
            "wrf.nc",
            "relative_humidity",
            ["specific_humidity", "PHB, PH, T, W"],
        ),
        (
            "classic.nc",
            "wind_speed",
            ["eastward_wind and northward_wind", "t, b, vi4, vf8, s"],
        ),
        (
            "classic.nc",
            "pressure",
            ["air_pressure", "t, b, vi4, vf8, s"],
        ),
        ("levels.nc", "wind_speed", ["units of u", "furlong"]),
    ] {
        let refused = open(&format!("netcdf/{file}"), Some(variable)).map(|_| ());
        let text = message(&refused.unwrap_err());
        for word in words {
            assert!(text.contains(word), "{file} {variable}: {text}");
        }
    }
}

#[test]
fn resampled_levels_get_the_numbers_of_the_levels_themselves() {
    // Uneven pressures: drawn from even heights, the ends are the levels as they are stored.
    let file = "netcdf/levels.nc";
    let [stored, drawn] = [true, false].map(|as_stored| {
        let source = open_as(file, Some("temperature"), as_stored).unwrap();
        (source.header().dims, whole(source.as_ref(), 0))
    });
    let ([nx, ny, _], levels) = stored;
    let ([.., nz], even) = drawn;
    assert!(nz > 3, "{nz}");
    let layer = (nx * ny) as usize;
    assert_eq!(levels[..layer], even[..layer]);
    assert_eq!(levels[2 * layer..], even[even.len() - layer..]);
}

#[test]
fn the_map_and_the_middle_of_the_grid_are_told() {
    let header = open(WRF, Some("T")).unwrap().header().clone();
    let map = header.map.expect("a map");
    assert_eq!(map.kind, MapKind::Lambert);
    assert_eq!(map.true_latitudes, [Some(30.0), Some(60.0)]);
    assert_eq!(map.standard_longitude, Some(-98.0));
    // The third column of five and between the second and third row of four; the file's f32 leave 8e-6.
    let [latitude, longitude] = map.center.expect("a centre");
    assert!(
        (latitude - (45.5 + 0.036 * 1.5 + 0.002)).abs() < 1e-5,
        "{latitude}"
    );
    assert!((longitude + 179.95).abs() < 1e-5, "{longitude}");
    let notes = header.notes.join("; ");
    assert!(notes.contains("not around CEN_LAT 39.000"), "{notes}");
    assert_eq!(open("netcdf/wrf.nc", Some("T")).unwrap().header().map, None);
}

#[test]
fn perturbation_potential_temperature_has_its_name() {
    // One file describes its T, the other does not.
    for file in [WRF, "netcdf/wrf.nc"] {
        let header = open(file, Some("T")).unwrap().header().clone();
        let name = header.long_name.as_deref();
        assert_eq!(name, Some("perturbation potential temperature"), "{file}");
        assert_eq!(header.standard_name, None);
        let notes = header.notes.join("; ");
        assert!(notes.contains("theta - 300 K"), "{file}: {notes}");
    }
    let header = open(WRF, Some("temperature")).unwrap().header().clone();
    assert_eq!(header.standard_name.as_deref(), Some("air_temperature"));
}

/// Values at time, z, y, x of a simulation of hurricane Katrina: temperature by MetPy 1.7.1, the others by numpy in f64.
#[test]
fn a_real_simulation_has_the_values_of_metpy() {
    let beside = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    let folder = std::env::var_os("STRATAVOX_DATA").map_or(beside, PathBuf::from);
    let path = folder.join("met-wrf/wrf_ci.nc");
    if !path.is_file() {
        println!("skipped: no {}", path.display());
        return;
    }
    let places: [[u32; 4]; 4] = [
        [0, 0, 0, 0],
        [1, 5, 20, 30],
        [3, 13, 47, 47],
        [2, 3, 24, 24],
    ];
    let rows = [
        (
            "temperature",
            [
                301.0280489222576,
                296.9180686419734,
                278.6650746753947,
                299.14177967602086,
            ],
            2e-3,
            269.0..304.0,
        ),
        (
            "pressure",
            [99707.6953125, 92156.421875, 48593.3515625, 95900.4609375],
            4e-3,
            48_000.0..100_000.0,
        ),
        (
            "relative_humidity",
            [
                87.17418936409366,
                85.71753664700856,
                50.68495348783315,
                91.10517106221347,
            ],
            1e-5,
            16.0..101.35,
        ),
        (
            "wind_speed",
            [
                8.879350673080276,
                18.869698507731794,
                11.992968189225293,
                19.740098635753423,
            ],
            1e-6,
            0.3..73.1,
        ),
    ];
    for (variable, wanted, tolerance, range) in rows {
        let selection = VolumeSelection {
            variable: Some(variable.to_owned()),
            as_stored: true,
            ..VolumeSelection::default()
        };
        let source = stratavox::format::open(&path, &selection, &Limits::default())
            .unwrap_or_else(|e| panic!("{}", message(&e)));
        for ([time, z, y, x], wanted) in places.into_iter().zip(wanted) {
            let region = VoxelBox {
                min: [x, y, z],
                max: [x + 1, y + 1, z + 1],
            };
            let pick = TimeComponent { time, component: 0 };
            let found = f64::from(source.read(pick, region).unwrap().voxels.stored(0));
            assert!(
                (found - wanted).abs() <= tolerance,
                "{variable}: {found}, not {wanted}"
            );
        }
        for time in 0..source.header().times {
            for value in whole(source.as_ref(), time) {
                let value = value.expect("no hole");
                assert!(range.contains(&value), "{variable}: {value}");
            }
        }
    }
}
