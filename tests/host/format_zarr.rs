//! Zarr stores of other writers, read whole and in parts, against what those writers read back.
#![cfg(feature = "zarr")]

use crate::truth;
use crate::zarr;

use serde_json::Value;
use sha2::{Digest, Sha256};
use stratavox::volume::{TimeComponent, VoxelBox};
use zarr::{Store, all, open, region, variants};

/// Numbers of 32 and 64 bits are kept as f32: 2^-24 of each.
const F32_ROUNDING: f64 = 1.0 / 16_777_216.0;

#[track_caller]
fn check(name: &str, numbers: &[f64], expected: &Value, is_rounded: bool) {
    let finite = || numbers.iter().enumerate().filter(|(_, x)| !x.is_nan());
    let sum: f64 = finite().map(|(_, x)| x).sum();
    let weighted: f64 = finite().map(|(k, x)| (k + 1) as f64 * x).sum();
    let size: f64 = finite().map(|(k, x)| (k + 1) as f64 * x.abs()).sum();
    let tolerance = if is_rounded { size * F32_ROUNDING } else { 0.0 };
    let nan = numbers.iter().filter(|x| x.is_nan()).count();
    assert_eq!(expected["nan"], nan, "{name}: NaN");
    for (what, found) in [("sum", sum), ("weighted", weighted)] {
        let wanted = expected[what].as_f64().unwrap();
        assert!(
            (found - wanted).abs() <= tolerance,
            "{name}: {what} {found}, not {wanted}"
        );
    }
}

#[test]
fn every_variant_of_the_format_has_the_numbers_that_its_writer_reads() {
    let mut count = 0;
    for (name, entry) in variants() {
        let store = Store::of(&name);
        for (path, expected) in entry["arrays"].as_object().unwrap() {
            let variable = Some(path.as_str()).filter(|path| !path.is_empty());
            let label = format!("{name} {path}");
            let source = open(&store.path(), variable).unwrap_or_else(|e| panic!("{label}: {e}"));
            let header = source.header();
            let shape: Vec<u64> = expected["shape"]
                .as_array()
                .unwrap()
                .iter()
                .map(|n| n.as_u64().unwrap())
                .collect();
            let sides: Vec<u64> = header.dims.iter().rev().map(|&n| n.into()).collect();
            assert!(shape.ends_with(&sides), "{label}: {shape:?} and {sides:?}");
            let total: u64 = shape.iter().product();
            let numbers =
                all(&*source).unwrap_or_else(|e| panic!("{label}: {}", zarr::message(&e)));
            assert_eq!(numbers.len() as u64, total, "{label}");
            check(&label, &numbers, expected, !header.stored.is_kept_exactly());
            count += 1;
        }
    }
    println!("{count} arrays");
    assert!(count > 90, "only {count} arrays");
}

#[test]
fn a_part_of_an_array_has_the_numbers_that_the_whole_has_there() {
    let mut parts = 0;
    for name in [
        "v2-fortran",
        "v2-slash",
        "v2-blosc-zstd-2",
        "v3-shards-transposed",
        "v3-shards-gaps",
        "v3-transpose",
        "v2-absent-i2",
        "ngff-0.4",
    ] {
        let store = Store::of(name);
        let source = store.open().unwrap();
        let header = source.header();
        let [nx, ny, nz] = header.dims;
        for time in 0..header.times {
            for component in 0..header.components {
                let pick = TimeComponent { time, component };
                let whole = region(&*source, pick, header.whole()).unwrap();
                for min in [
                    [0, 0, 0],
                    [1, 2, 1],
                    [nx - 1, 0, nz - 1],
                    [nx / 2, ny / 2, 0],
                ] {
                    for max in [[nx, ny, nz], [nx, ny / 2 + 1, nz], [nx / 2 + 1, ny, nz]] {
                        if (0..3).any(|k| min[k] >= max[k]) {
                            continue;
                        }
                        let part = region(&*source, pick, VoxelBox { min, max }).unwrap();
                        let mut wanted = Vec::new();
                        for z in min[2]..max[2] {
                            for y in min[1]..max[1] {
                                for x in min[0]..max[0] {
                                    wanted.push(whole[(x + nx * (y + ny * z)) as usize]);
                                }
                            }
                        }
                        assert_eq!(part, wanted, "{name} {pick:?} {min:?} {max:?}");
                        parts += 1;
                    }
                }
            }
        }
    }
    assert!(parts > 60, "only {parts} parts");
}

#[test]
fn only_chunks_that_meet_the_wanted_box_are_decoded() {
    // The chunks behind the first layers are damaged: a box that needs none of them is read.
    let store = Store::of("v2-zlib");
    store.write("1.0.0", b"nothing");
    store.write("1.1.0", b"nothing");
    let source = store.open().unwrap();
    let [nx, ny, nz] = source.header().dims;
    let near = VoxelBox {
        min: [0; 3],
        max: [nx, ny, 2],
    };
    assert!(region(&*source, TimeComponent::default(), near).is_ok());
    let far = VoxelBox {
        min: [0; 3],
        max: [nx, ny, nz],
    };
    assert!(region(&*source, TimeComponent::default(), far).is_err());
}

#[test]
fn what_is_not_there_is_the_fill_value_and_said() {
    let absent = |name: &str| {
        let source = Store::of(name).open().unwrap();
        source.header().notes.join("; ")
    };
    assert_eq!(
        absent("v2-absent-i2"),
        "2 of 4 chunk files are not there: they are read as the fill value -7"
    );
    assert!(absent("v2-absent-null").ends_with(
        "3 of 4 chunk files are not there: they are read as 0, the file names no fill value"
    ));
    assert!(
        absent("v2-absent-all").contains("4 of 4"),
        "{}",
        absent("v2-absent-all")
    );
    assert_eq!(absent("v2-zlib"), "");
}

#[test]
fn arrays_of_a_group_are_variables_and_lines_are_none() {
    for name in [
        "v2-group",
        "v2-group-consolidated",
        "v3-group",
        "v3-group-consolidated",
    ] {
        let store = Store::of(name);
        let source = store.open().unwrap();
        assert_eq!(source.header().variables, ["a", "deep/er/b"], "{name}");
        let source = open(&store.path(), Some("deep/er/b")).unwrap();
        assert_eq!(source.header().variables, ["deep/er/b", "a"], "{name}");
        assert_eq!(source.header().components, 2, "{name}");
        let error = open(&store.path(), Some("none")).map(|_| ()).unwrap_err();
        assert!(error.to_string().contains("one of a, deep/er/b"), "{error}");
    }
}

#[test]
fn weather_has_places_moments_units_and_values() {
    for name in ["weather-v2", "weather-v3"] {
        let store = Store::of(name);
        let source = store.open().unwrap();
        let header = source.header();
        assert_eq!(header.variables, ["temp"], "{name}");
        assert_eq!((header.dims, header.times), ([5, 4, 3], 2), "{name}");
        assert_eq!(
            header.time_names,
            ["2020-02-28T21:00:00", "2020-02-29T03:00:00"],
            "{name}: a leap day"
        );
        assert_eq!(header.unit.as_deref(), Some("K"), "{name}");
        let rescale = (header.rescale.slope, header.rescale.intercept);
        assert_eq!(rescale, (0.5, 280.0), "{name}");
        assert_eq!(header.fill, Some(-999.0), "{name}");
        // Kilometres: levels 0.5 apart, the first latitude in the north, a degree of it about 111.
        let steps = header.world_from_voxel.matrix3;
        let up = steps.z_axis.z;
        assert!(
            up == 0.5 || header.notes.iter().any(|note| note.contains("stretch")),
            "{name}: {up}"
        );
        assert!(
            (110.0..113.0).contains(&-steps.y_axis.y),
            "{name}: {}",
            steps.y_axis
        );
        assert!(steps.x_axis.x > 0.0, "{name}: {}", steps.x_axis);
    }
}

#[test]
fn members_of_an_ensemble_are_what_the_manifest_says() {
    for entry in truth::entries("zarr") {
        let path = truth::folder().unwrap();
        let path = path.join(entry["path"].as_str().unwrap());
        for variable in entry["variables"].as_array().unwrap() {
            let name = variable["name"].as_str().unwrap();
            // The file's order: members, then times.
            let mut bytes = Vec::new();
            for member in 0..2 {
                let source = open(&path, Some(&format!("{name}[number={member}]"))).unwrap();
                let header = source.header();
                println!("{name}: {header:?}");
                assert_eq!((header.dims, header.times), ([120, 61, 2], 4), "{name}");
                assert_eq!(header.components, 1, "{name}");
                assert_eq!(header.time_names[1], "2017-01-01T12:00:00", "{name}");
                for number in all(&*source).unwrap() {
                    bytes.extend((number as f32).to_le_bytes());
                }
            }
            let digest = Sha256::digest(&bytes);
            let digest: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
            let wanted = variable["voxel_sha256"].as_str();
            assert_eq!(Some(digest.as_str()), wanted, "{name}");
        }
    }
}

/// Heights and curved longitudes say where voxels lie by their standard names and units; `coordinates` need not list
/// them.
#[test]
fn variables_that_say_where_others_lie_come_last() {
    let store = Store::new(&[(".zgroup".to_owned(), br#"{"zarr_format":2}"#.to_vec())]);
    let add = |name: &str, shape: &[u64], attributes: serde_json::Value| {
        let names = &["z", "y", "x"][3 - shape.len()..];
        let mut attributes = attributes;
        attributes["_ARRAY_DIMENSIONS"] = serde_json::json!(names);
        let array = serde_json::json!({
            "zarr_format": 2, "shape": shape, "chunks": shape, "dtype": "<f4", "compressor": null,
            "fill_value": 0, "order": "C", "filters": null
        });
        store.write(&format!("{name}/.zarray"), array.to_string());
        store.write(&format!("{name}/.zattrs"), attributes.to_string());
        let voxels = shape.iter().product::<u64>();
        let numbers = (0..voxels).flat_map(|i| (i as f32).to_le_bytes());
        let chunk = vec!["0"; shape.len()].join(".");
        store.write(&format!("{name}/{chunk}"), numbers.collect::<Vec<_>>());
    };
    add(
        "altitude",
        &[3, 4, 5],
        serde_json::json!({"standard_name": "altitude", "units": "m"}),
    );
    add(
        "east",
        &[3, 4, 5],
        serde_json::json!({"units": "degrees_east"}),
    );
    add("slp", &[4, 5], serde_json::json!({"units": "Pa"}));
    add("theta", &[3, 4, 5], serde_json::json!({"units": "K"}));
    let source = store.open().unwrap();
    let names = &source.header().variables;
    assert_eq!(names[..], ["theta", "slp", "altitude", "east"]);
}
