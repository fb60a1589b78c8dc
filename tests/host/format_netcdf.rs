//! NetCDF files that the NetCDF library wrote, against what it reads from them.
#![cfg(feature = "netcdf")]

use crate::files;
use crate::fixtures;

use files::{Folder, message};
use fixtures::{json, open, open_as, values};
use glam::DVec3;
use stratavox::volume::{Header, Limits, TimeComponent, VolumeSelection, VoxelBox};

fn center(header: &Header, index: [f64; 3]) -> DVec3 {
    let voxel = DVec3::from_array(index) + DVec3::splat(0.5);
    header.world_from_voxel.transform_point3(voxel)
}

#[track_caller]
fn assert_near(found: DVec3, wanted: [f64; 3]) {
    let error = (found - DVec3::from_array(wanted)).abs().max_element();
    assert!(
        error < 1e-9 * found.length().max(1.0),
        "{found}, not {wanted:?}"
    );
}

#[test]
fn every_variant_gives_the_numbers_that_its_own_library_reads() {
    let expected = json("netcdf/expected.json");
    let mut compared = 0;
    for (name, entries) in expected.as_object().unwrap() {
        for entry in entries.as_array().unwrap() {
            let variable = entry["variable"].as_str().unwrap();
            let asked = entry["asked"].as_str().unwrap_or(variable);
            let place = format!("{name} {asked}");
            let source = open(&format!("netcdf/{name}"), Some(asked))
                .unwrap_or_else(|e| panic!("{place}: {}", message(&e)));
            let header = source.header();
            assert_eq!(header.format.name(), "netcdf");
            assert_eq!(header.variables[0], asked);
            let dims: Vec<u64> = header.dims.iter().map(|&n| n.into()).collect();
            let mut wanted_dims: Vec<u64> = entry["dims"]
                .as_array()
                .unwrap()
                .iter()
                .map(|n| n.as_u64().unwrap())
                .collect();
            wanted_dims.resize(3, 1);
            assert_eq!(dims, wanted_dims, "{place}");
            let pick = TimeComponent {
                time: u32::from(header.times > 1),
                component: 0,
            };
            let found = values(source.as_ref(), pick);
            let wanted: Vec<Option<f64>> = entry["numbers"]
                .as_array()
                .unwrap()
                .iter()
                .map(|n| n.as_f64())
                .collect();
            assert_eq!(found, wanted, "{place}");
            let times: Vec<String> = entry["times"]
                .as_array()
                .unwrap()
                .iter()
                .map(|time| {
                    time.as_str()
                        .unwrap()
                        .trim_end_matches('0')
                        .trim_end_matches('.')
                        .to_owned()
                })
                .map(|time| {
                    if time.ends_with(':') {
                        time + "00"
                    } else {
                        time
                    }
                })
                .collect();
            let names: Vec<String> = header
                .time_names
                .iter()
                .map(|n| n.trim_end_matches('0').to_owned())
                .map(|time| {
                    if time.ends_with(':') {
                        time + "00"
                    } else {
                        time
                    }
                })
                .collect();
            assert_eq!(names, times, "{place}");
            compared += found.len();
        }
    }
    println!("{compared} numbers compared");
    assert!(compared > 600, "only {compared} numbers");
}

#[test]
fn a_box_is_the_same_part_of_the_whole_in_any_order_of_dimensions() {
    for (name, variable) in [
        ("netcdf/classic.nc", "t"),
        ("netcdf/order.nc", "w"),
        ("netcdf/packed.nc", "t"),
    ] {
        let source = open(name, Some(variable)).unwrap();
        let header = source.header();
        let pick = TimeComponent {
            time: header.times - 1,
            component: 0,
        };
        let whole = source.read(pick, header.whole()).unwrap().voxels;
        let region = VoxelBox {
            min: [1, 0, 1],
            max: [3, 2, 3],
        };
        let part = source.read(pick, region).unwrap().voxels;
        let mut i = 0;
        for z in 1..3 {
            for y in 0..2 {
                for x in 1..3 {
                    let at = x + header.dims[0] as usize * (y + header.dims[1] as usize * z);
                    assert_eq!(part.stored(i), whole.stored(at), "{name}");
                    i += 1;
                }
            }
        }
        assert_eq!(i, part.len());
    }
}

#[test]
fn north_is_north_and_up_is_up_in_kilometres_of_the_earth() {
    // 1 degree of a sphere of 6371.0088 km.
    let degree = 6371.0088 * std::f64::consts::PI / 180.0;
    let source = open("netcdf/classic.nc", Some("t")).unwrap();
    let header = source.header();
    assert!(header.is_earth);
    let east = degree * 50.5_f64.to_radians().cos();
    let lengths = header.degree_lengths;
    let [along_x, along_y] = lengths.map(|length| length.expect("degrees along both"));
    assert!((along_x / east - 1.0).abs() < 1e-12, "{along_x} km");
    assert!((along_y / degree - 1.0).abs() < 1e-12, "{along_y} km");
    assert_near(center(header, [0.0; 3]), [5.0 * east, 50.0 * degree, 0.010]);
    assert_near(
        center(header, [3.0, 1.0, 2.0]),
        [8.0 * east, 51.0 * degree, 0.030],
    );
    assert_eq!(header.unit.as_deref(), Some("K"));
    // Latitudes that fall, depths that grow downwards, longitudes that pass 360.
    let source = open("netcdf/order.nc", Some("w")).unwrap();
    let header = source.header();
    let east = degree * 12_f64.to_radians().cos();
    assert_near(
        center(header, [0.0; 3]),
        [350.0 * east, -10.0 * degree, -0.005],
    );
    assert_near(
        center(header, [3.0, 4.0, 2.0]),
        [365.0 * east, -14.0 * degree, -0.025],
    );
    // Pressures: the standard atmosphere's heights of 1000 and 500 hPa, to the printed metre.
    let source = open("netcdf/packed.nc", Some("t")).unwrap();
    let header = source.header();
    let [bottom, top] = [0.0, 2.0].map(|z| center(header, [0.0, 0.0, z]).z);
    assert!((bottom - 0.111).abs() < 0.001, "{bottom} km");
    assert!((top - 5.574).abs() < 0.001, "{top} km");
}

#[test]
fn a_bent_grid_lies_flat_with_the_steps_of_its_middle() {
    let degree = 6371.0088 * std::f64::consts::PI / 180.0;
    let source = open("netcdf/curved.nc", Some("placed")).unwrap();
    let header = source.header();
    assert!(header.is_earth);
    let notes = header.notes.join("; ");
    assert!(notes.contains("the grid is drawn flat"), "{notes}");
    assert_eq!(header.degree_lengths, [None; 2]);
    let step = center(header, [1.0, 1.0, 0.0]) - center(header, [0.0; 3]);
    // A great circle cuts the corner of the circle of latitude by one part in a million here.
    let east = 0.25 * degree * 59_f64.to_radians().cos();
    assert!((step.x - east).abs() < 1e-5 * east, "{step}, not {east} km");
    assert!((step.y + 0.5 * degree).abs() < 1e-9 * degree, "{step}");
    assert!(!header.variables.iter().any(|name| name == "lat2d"));
    let bare = open("netcdf/curved.nc", Some("bare")).unwrap();
    let notes = bare.header().notes.join("; ");
    assert!(
        notes.contains("no coordinates along x: points are taken 1 km apart"),
        "{notes}"
    );
}

#[test]
fn of_an_ensemble_the_first_member_is_taken_and_another_by_its_index() {
    let source = open("netcdf/order.nc", Some("w")).unwrap();
    let notes = source.header().notes.join("; ");
    assert!(
        notes.contains("of 2 along `number` the first is taken"),
        "{notes}"
    );
    assert!(notes.contains("w[number=1]"), "{notes}");
    let chosen = open("netcdf/order.nc", Some("w[number=0]")).unwrap();
    assert!(!chosen.header().notes.join("; ").contains("number"));
    for (asked, part) in [
        ("w[number=2]", "an index below 2"),
        (
            "w[lon=1]",
            "a dimension of the variable beside time and space",
        ),
        ("w[number]", "NAME[DIMENSION=INDEX]"),
        ("w[number=1", "NAME[DIMENSION=INDEX]"),
        ("nope", "one of w, found `nope`"),
        ("lon", "at least two axes"),
    ] {
        let error = message(&open("netcdf/order.nc", Some(asked)).err().expect(asked));
        assert!(error.contains(part), "{asked}: {error}");
    }
}

#[test]
fn a_field_that_is_linear_stays_exactly_so_on_even_points() {
    let stored = open("netcdf/uneven.nc", Some("f")).unwrap();
    assert_eq!(stored.header().dims, [8, 8, 4]);
    let even = open_as("netcdf/uneven.nc", Some("f"), false).unwrap();
    let header = even.header();
    // Heights 0, 100, 300, 700 and latitudes from 70 to -60, the nearest 5 apart.
    assert_eq!(header.dims, [8, 27, 8]);
    let notes = header.notes.join("; ");
    assert!(
        notes.contains("4 unevenly spaced points along z are drawn as 8"),
        "{notes}"
    );
    let degree = 6371.0088 * std::f64::consts::PI / 180.0;
    let values = values(even.as_ref(), TimeComponent::default());
    let mut i = 0;
    for z in 0..header.dims[2] {
        for y in 0..header.dims[1] {
            for x in 0..8 {
                let place = center(header, [x, y, z].map(f64::from));
                let wanted = 1000.0 * place.z + 8.0 * place.y / degree + f64::from(x);
                // Two roundings to f32, of the stored number and of the sum.
                let room = 2.0 * f64::from(f32::EPSILON) * (wanted.abs() + 720.0);
                let found = values[i].expect("a number");
                assert!(
                    (found - wanted).abs() <= room,
                    "{found}, not {wanted} at {x} {y} {z}"
                );
                i += 1;
            }
        }
    }
    assert_eq!(i, values.len());
    // A part of it is the same.
    let region = VoxelBox {
        min: [2, 3, 1],
        max: [5, 7, 6],
    };
    let part = even.read(TimeComponent::default(), region).unwrap().voxels;
    let mut i = 0;
    for z in 1..6 {
        for y in 3..7 {
            for x in 2..5 {
                let at = x + 8 * (y + header.dims[1] as usize * z);
                assert_eq!(Some(f64::from(part.stored(i))), values[at]);
                i += 1;
            }
        }
    }
}

#[test]
fn a_file_that_was_cut_is_refused() {
    let folder = Folder::new();
    let mut tried = 0;
    for name in [
        "classic.nc",
        "offset64.nc",
        "cdf5.nc",
        "curved.nc",
        "wrf.nc",
        "nc4.nc",
        "packed.nc",
    ] {
        let bytes = std::fs::read(fixtures::path(&format!("netcdf/{name}"))).unwrap();
        let cuts = (0..bytes.len().min(4096)).step_by(7);
        let last = if name.starts_with("nc4") || name.starts_with("packed") {
            bytes.len() - 1
        } else {
            // The last record ends in up to three bytes that carry nothing.
            bytes.len() - 4
        };
        for cut in cuts.chain([last]).filter(|&cut| cut <= last) {
            let path = folder.write(name, &bytes[..cut]);
            let all =
                stratavox::format::open(&path, &VolumeSelection::default(), &Limits::default());
            let Ok(source) = all else {
                tried += 1;
                continue;
            };
            // Whatever variable is read: a classic header tells where all of them end.
            assert!(!bytes.starts_with(b"CDF"), "{name} cut at {cut} opens");
            let any_fails = source.header().variables.clone().iter().any(|variable| {
                let wanted = VolumeSelection {
                    variable: Some(variable.clone()),
                    ..VolumeSelection::default()
                };
                let source = stratavox::format::open(&path, &wanted, &Limits::default());
                source.is_err()
                    || source.is_ok_and(|s| {
                        let last = TimeComponent {
                            time: s.header().times - 1,
                            component: 0,
                        };
                        s.read(last, s.header().whole()).is_err()
                    })
            });
            assert!(any_fails, "{name} cut at {cut}");
            tried += 1;
        }
    }
    println!("{tried} cut files refused");
    assert!(tried > 1000);
}

#[test]
fn a_variable_that_cannot_be_is_refused_by_its_name() {
    let folder = Folder::new();
    let refused = |bytes: &[u8]| {
        let path = folder.write("a.nc", bytes);
        let error = stratavox::format::open(&path, &VolumeSelection::default(), &Limits::default());
        message(&error.err().expect("no volume"))
    };
    let error = refused(b"CDF\x01");
    assert!(error.contains("netcdf"), "{error}");
    let error = refused(b"CDF\x01\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0");
    assert!(error.contains("at least two axes of space"), "{error}");
    let error = refused(b"\x89HDF\r\n\x1a\n");
    assert!(error.contains("hdf5"), "{error}");
}
