//! Samples in NetCDF files by CF's discrete sampling geometries: each array that chapter 9 allows gives the same points.
#![cfg(all(feature = "files", feature = "netcdf"))]

use crate::files::{Folder, message};
use crate::netcdf::{Variable, netcdf};
use glam::DVec3;
use stratavox::format::{self, PointColumns, PointFile, holds_samples, open_points};
use stratavox::volume::{Format, Limits, Source, VolumeSelection};

/// Kilometres of a degree of latitude, by the Earth's mean radius.
const DEGREE: f64 = 6371.0088 * std::f64::consts::PI / 180.0;

/// Latitudes of the two stations: 44 is half way.
const LATITUDES: [f64; 2] = [42.0, 46.0];
const LONGITUDES: [f64; 2] = [10.0, 13.5];
/// Of each sample: its station, its height in metres, its value.
const SAMPLES: [(usize, f64, f64); 5] = [
    (0, 100.0, 1.5),
    (0, 250.0, -2.0),
    (0, 900.0, 7.25),
    (1, 50.0, 3.0),
    (1, 75.0, 4.5),
];

type Texts<'a> = &'a [(&'a str, &'a str)];

const DATA: Texts = &[
    ("units", "K"),
    ("standard_name", "air_temperature"),
    ("coordinates", "time lat lon alt"),
];
const LON: Texts = &[("units", "degrees_east")];
const LAT: Texts = &[("standard_name", "latitude")];
const ALT: Texts = &[("units", "m"), ("positive", "up"), ("axis", "Z")];

fn variable<'a>(
    name: &'a str,
    dimensions: &'a [usize],
    texts: Texts<'a>,
    values: impl Into<Vec<f64>>,
) -> Variable<'a> {
    Variable {
        name,
        dimensions,
        texts,
        numbers: &[],
        values: values.into(),
    }
}

fn of(pick: fn(&(usize, f64, f64)) -> f64) -> Vec<f64> {
    SAMPLES.iter().map(pick).collect()
}

fn read_as(bytes: &[u8], value: Option<&str>) -> Result<PointFile, String> {
    let folder = Folder::new();
    let path = folder.write("a.nc", bytes);
    let columns = PointColumns {
        value: value.map(str::to_owned),
        ..PointColumns::default()
    };
    open_points(&path, &columns, &Limits::default()).map_err(|error| message(&error))
}

fn read(bytes: &[u8]) -> PointFile {
    read_as(bytes, None).unwrap_or_else(|error| panic!("{error}"))
}

/// Places and values, in their order.
fn found(file: &PointFile) -> Vec<(DVec3, f32)> {
    let points = file.points();
    let values = points.values().iter().copied();
    points.places().iter().copied().zip(values).collect()
}

/// What the samples are in the world.
fn wanted() -> Vec<(DVec3, f32)> {
    let along_x = DEGREE * 44.0_f64.to_radians().cos();
    let point = |&(station, height, value): &(usize, f64, f64)| {
        let place = [
            LONGITUDES[station] * along_x,
            LATITUDES[station] * DEGREE,
            height / 1000.0,
        ];
        (DVec3::from_array(place), value as f32)
    };
    SAMPLES.iter().map(point).collect()
}

#[track_caller]
fn assert_same(found: &[(DVec3, f32)], wanted: &[(DVec3, f32)]) {
    assert_eq!(found.len(), wanted.len());
    for ((place, value), (wanted, number)) in found.iter().zip(wanted) {
        assert!(
            (*place - *wanted).abs().max_element() < 1e-9,
            "{place} {wanted}"
        );
        assert_eq!(value, number);
    }
}

/// Samples one after the other: each with its place, counted by station, or naming theirs.
fn one_after_the_other() -> Vec<Vec<u8>> {
    let dimensions = [("obs", 5), ("station", 2)];
    let file = |feature, more: Vec<Variable>| {
        let mut variables = vec![
            variable("t", &[0], DATA, of(|s| s.2)),
            variable("alt", &[0], ALT, of(|s| s.1)),
        ];
        variables.extend(more);
        netcdf(&dimensions, &[("featureType", feature)], &variables)
    };
    let stations = || {
        vec![
            variable("lon", &[1], LON, LONGITUDES),
            variable("lat", &[1], LAT, LATITUDES),
        ]
    };
    let with = |one| stations().into_iter().chain([one]).collect();
    vec![
        file(
            "point",
            vec![
                variable("lon", &[0], LON, of(|s| LONGITUDES[s.0])),
                variable("lat", &[0], LAT, of(|s| LATITUDES[s.0])),
            ],
        ),
        file(
            "profile",
            with(variable(
                "n",
                &[1],
                &[("sample_dimension", "obs")],
                [3.0, 2.0],
            )),
        ),
        file(
            "Profile",
            with(variable(
                "i",
                &[0],
                &[("instance_dimension", "station")],
                of(|s| s.0 as f64),
            )),
        ),
    ]
}

#[test]
fn samples_of_all_arrays_are_the_same_points() {
    for bytes in one_after_the_other() {
        let file = read(&bytes);
        assert_same(&found(&file), &wanted());
        let header = file.header();
        assert_eq!(header.format, Format::NetCdf);
        assert_eq!(header.unit.as_deref(), Some("K"));
        assert_eq!(header.standard_name.as_deref(), Some("air_temperature"));
        assert!(header.is_earth && header.variables == ["t"]);
    }
    // Two stations of three heights each, one of them empty: incomplete, with the fill of each variable.
    let fill = [("_FillValue", -999.9)];
    let mut values = of(|s| s.2);
    let mut heights = of(|s| s.1);
    values.push(-999.9);
    heights.push(-999.9);
    let filled = |name, texts, values| Variable {
        name,
        dimensions: &[1, 0],
        texts,
        numbers: &fill,
        values,
    };
    let incomplete = netcdf(
        &[("z", 3), ("station", 2)],
        &[("featureType", "timeSeriesProfile")],
        &[
            variable("lat", &[1], LAT, LATITUDES),
            variable("lon", &[1], LON, LONGITUDES),
            filled("t", DATA, values),
            filled("alt", ALT, heights),
        ],
    );
    let file = read(&incomplete);
    assert_same(&found(&file), &wanted());
    let notes = file.notes().join("\n");
    assert!(notes.contains("1 row was dropped"), "{notes}");
}

#[test]
fn depths_pressures_and_times_of_stations_are_placed() {
    let series = |vertical: Vec<Variable<'static>>| {
        let mut variables = vec![
            variable("lat", &[1], LAT, LATITUDES),
            variable("lon", &[1], LON, LONGITUDES),
            variable(
                "time",
                &[0],
                &[("units", "hours since 2005-08-28")],
                [0.0, 6.0],
            ),
            Variable {
                name: "t",
                dimensions: &[1, 0],
                texts: DATA,
                numbers: &[("scale_factor", 0.5), ("add_offset", 10.0)],
                values: vec![2.0, 4.0, 6.0, 8.0],
            },
        ];
        variables.extend(vertical);
        netcdf(
            &[("time", 2), ("station", 2)],
            &[("featureType", "timeSeries")],
            &variables,
        )
    };
    let depth: Texts = &[("units", "km"), ("positive", "down")];
    let pressure: Texts = &[("units", "Pa"), ("standard_name", "air_pressure")];
    for (vertical, heights, note) in [
        (vec![], [0.0, 0.0], "the samples have no heights"),
        (
            vec![variable("alt", &[1], depth, [1.25, 2.0])],
            [-1.25, -2.0],
            "times are shown together",
        ),
        // The standard atmosphere of 1976: 0 at 1013.25 hPa, 11 km at 226.3206 hPa.
        (
            vec![variable("alt", &[1], pressure, [101_325.0, 22_632.06])],
            [0.0, 11.0],
            "standard atmosphere",
        ),
    ] {
        let file = read(&series(vertical));
        let points = found(&file);
        assert_eq!(
            points.iter().map(|(_, value)| *value).collect::<Vec<_>>(),
            [11.0, 12.0, 13.0, 14.0]
        );
        for (i, (place, _)) in points.iter().enumerate() {
            let station = i / 2;
            assert!(
                (place.y - LATITUDES[station] * DEGREE).abs() < 1e-9,
                "{place}"
            );
            // Pressures have seven digits.
            assert!((place.z - heights[station]).abs() < 1e-5, "{place}");
        }
        assert!(file.notes().join("\n").contains(note), "{:?}", file.notes());
    }
}

#[test]
fn a_file_of_samples_is_known_by_what_it_says() {
    let folder = Folder::new();
    let limits = Limits::default();
    let bytes = one_after_the_other().remove(1);
    let path = folder.write("a.nc", &bytes);
    assert!(holds_samples(&path, &limits));
    // As a volume it is that of their means.
    let source = format::open(&path, &VolumeSelection::default(), &limits).expect("a volume");
    assert!(
        source
            .header()
            .notes
            .iter()
            .any(|note| note.contains("volume of their means"))
    );
    let grid = netcdf(
        &[("obs", 5)],
        &[],
        &[variable("t", &[0], DATA, of(|s| s.2))],
    );
    let path = folder.write("b.nc", grid);
    assert!(!holds_samples(&path, &limits) && !holds_samples(&folder.path("none.nc"), &limits));
    let refused = open_points(&path, &PointColumns::default(), &limits).expect_err("a grid");
    assert!(message(&refused).contains("featureType"), "{refused}");
}

#[test]
fn what_is_wrong_with_samples_is_said() {
    let dimensions = [("obs", 5), ("station", 2)];
    let base = || {
        vec![
            variable("t", &[0], DATA, of(|s| s.2)),
            variable("lon", &[1], LON, LONGITUDES),
            variable("lat", &[1], LAT, LATITUDES),
        ]
    };
    let counts = |values: [f64; 2]| variable("n", &[1], &[("sample_dimension", "obs")], values);
    let index =
        |values: [f64; 5]| variable("i", &[0], &[("instance_dimension", "station")], values);
    for (more, wanted) in [
        (vec![], ["lon", "dimensions of t"]),
        (vec![counts([3.0, 3.0])], ["`n`", "counts of 5 samples"]),
        (
            vec![counts([-1.0, 6.0])],
            ["`n`", "whole numbers from 0 on"],
        ),
        (vec![counts([4e9, 4e9])], ["`n`", "counts of 5 samples"]),
        (
            vec![index([0.0, 0.0, 0.0, 1.0, 2.0])],
            ["instance_dimension", "an index under 2"],
        ),
        (
            vec![index([0.0, 0.0, 0.0, 1.0, 0.5])],
            ["`i`", "whole numbers from 0 on"],
        ),
        (
            vec![
                counts([3.0, 2.0]),
                variable(
                    "alt",
                    &[0],
                    &[("units", "dbar"), ("axis", "Z")],
                    of(|s| s.1),
                ),
            ],
            ["units of alt", "a length or a pressure of the air"],
        ),
    ] {
        let mut variables = base();
        variables.extend(more);
        let bytes = netcdf(&dimensions, &[("featureType", "profile")], &variables);
        let refused = read_as(&bytes, None).expect_err("something is wrong");
        assert!(
            wanted.iter().all(|word| refused.contains(word)),
            "{refused}: {wanted:?}"
        );
    }
    let feature = [("featureType", "point")];
    let bytes = netcdf(&dimensions, &feature, &base()[..2]);
    assert!(
        read_as(&bytes, None)
            .expect_err("no latitude")
            .contains("latitude of samples")
    );
    let bytes = netcdf(&dimensions, &feature, &base()[1..]);
    assert!(
        read_as(&bytes, None)
            .expect_err("no data")
            .contains("variable with `coordinates`")
    );
    let bytes = one_after_the_other().remove(0);
    assert!(
        read_as(&bytes, Some("q"))
            .expect_err("no q")
            .contains("wanted one of t")
    );
    // Cut anywhere, or with other bytes: an error or points, and no panic.
    for length in 0..bytes.len() {
        let _ = read_as(&bytes[..length], None).expect_err("cut");
    }
    for at in 0..bytes.len() {
        let mut changed = bytes.clone();
        changed[at] ^= 0x55;
        let _ = read_as(&changed, None);
    }
}
