//! HDF5 files that h5py wrote, against what it reads from them.
#![cfg(feature = "netcdf")]

use crate::files;
use crate::fixtures;

use files::{Folder, message};
use fixtures::{json, open, values};
use glam::DVec3;
use stratavox::volume::{ComponentKind, Limits, TimeComponent, VolumeSelection};

#[test]
fn every_data_set_gives_the_numbers_that_h5py_reads() {
    let mut compared = 0;
    for entry in json("hdf5/expected.json").as_array().unwrap() {
        let name = entry["name"].as_str().unwrap();
        let shape: Vec<u64> = entry["shape"]
            .as_array()
            .unwrap()
            .iter()
            .map(|n| n.as_u64().unwrap())
            .collect();
        if matches!(name, "axes/line" | "axes/many") {
            continue;
        }
        let source =
            open("hdf5/kinds.h5", Some(name)).unwrap_or_else(|e| panic!("{name}: {}", message(&e)));
        let header = source.header();
        assert_eq!(
            header.stored.name(),
            entry["type"].as_str().unwrap(),
            "{name}"
        );
        let wanted: Vec<f64> = entry["numbers"]
            .as_array()
            .unwrap()
            .iter()
            .map(|n| n.as_f64().unwrap())
            .collect();
        let components = header.components as usize;
        let mut found = vec![f64::NAN; wanted.len()];
        let count = header.voxel_count() as usize;
        for time in 0..header.times {
            for component in 0..header.components {
                let numbers = values(source.as_ref(), TimeComponent { time, component });
                for (i, number) in numbers.into_iter().enumerate() {
                    let at = (time as usize * count + i) * components + component as usize;
                    found[at] = number.expect("HDF5 has no holes");
                }
            }
        }
        assert_eq!(found, wanted, "{name} {shape:?}");
        compared += wanted.len();
    }
    println!("{compared} numbers compared");
    assert!(compared > 1800, "only {compared} numbers");
}

#[test]
fn chunks_of_zstandard_are_read_and_damage_in_them_is_an_error() {
    let wanted: Vec<Option<f64>> = (0..60).map(|n| Some(f64::from(n))).collect();
    for (file, name) in [
        ("hdf5/zstd.h5", "plain"),
        ("hdf5/zstd.h5", "shuffled"),
        ("hdf5/zstd.h5", "checked"),
        ("netcdf/zstd.nc", "a"),
    ] {
        let source = open(file, Some(name)).unwrap_or_else(|e| panic!("{name}: {}", message(&e)));
        assert_eq!(source.header().dims, [5, 4, 3], "{name}");
        assert_eq!(
            values(source.as_ref(), TimeComponent::default()),
            wanted,
            "{name}"
        );
    }
    // The first frame of the file belongs to `plain`: its magic number, then a byte within.
    let whole = std::fs::read(fixtures::path("hdf5/zstd.h5")).unwrap();
    let magic = [0x28, 0xb5, 0x2f, 0xfd];
    let frame = whole.windows(4).position(|bytes| bytes == magic).unwrap();
    let folder = Folder::new();
    for at in [frame, frame + 4] {
        let mut bytes = whole.clone();
        bytes[at] ^= 0x3f;
        let path = folder.write("a.h5", &bytes);
        let wanted = VolumeSelection {
            variable: Some("plain".to_owned()),
            ..VolumeSelection::default()
        };
        let source = stratavox::format::open(&path, &wanted, &Limits::default()).unwrap();
        let whole = source.header().whole();
        let error = source
            .read(TimeComponent::default(), whole)
            .expect_err("damage");
        assert!(message(&error).contains("Zstandard"), "{}", message(&error));
    }
}

#[test]
fn axes_run_t_z_y_x_c() {
    let header = |name| open("hdf5/kinds.h5", Some(name)).unwrap().header().clone();
    let vector = header("axes/vector");
    assert_eq!(
        (vector.dims, vector.components, vector.times),
        ([5, 4, 3], 3, 1)
    );
    assert_eq!(vector.meaning, ComponentKind::Vector);
    let times = header("axes/times");
    assert_eq!(
        (times.dims, times.components, times.times),
        ([5, 4, 3], 1, 6)
    );
    let both = header("axes/both");
    assert_eq!((both.dims, both.components, both.times), ([5, 4, 3], 2, 2));
    assert_eq!(both.meaning, ComponentKind::Numbers);
    assert_eq!(header("axes/plane").dims, [5, 4, 1]);
    assert_eq!(header("layout/one").dims, [5, 4, 3]);
}

#[test]
fn a_voxel_lies_where_the_attributes_say() {
    let corners = |name| {
        let source = open("hdf5/kinds.h5", Some(name)).unwrap();
        let header = source.header();
        let at = |p: [f64; 3]| {
            let voxel = DVec3::from_array(p) + DVec3::splat(0.5);
            header.world_from_voxel.transform_point3(voxel).to_array()
        };
        [at([0.0; 3]), at([1.0, 1.0, 1.0])]
    };
    for (name, first, next) in [
        ("place/spaced", [0.01, 0.02, 0.03], [1.01, 2.02, 3.03]),
        ("place/plain", [10.0, 20.0, 30.0], [11.0, 22.0, 33.0]),
        ("place/turned", [5.0, 6.0, 7.0], [4.0, 7.0, 8.0]),
        ("layout/gzip", [0.0; 3], [1.0; 3]),
    ] {
        // The corner is half a step from the centre: one rounding there and one back.
        for (found, wanted) in corners(name)
            .as_flattened()
            .iter()
            .zip([first, next].concat())
        {
            assert!(
                (found - wanted).abs() <= 4.0 * f64::EPSILON * 33.0,
                "{name}: {found}, not {wanted}"
            );
        }
    }
    let spaced = open("hdf5/kinds.h5", Some("place/spaced")).unwrap();
    assert_eq!(spaced.header().unit.as_deref(), Some("counts"));
}

#[test]
fn data_sets_are_found_by_their_paths_and_listed_once() {
    let source = open("hdf5/kinds.h5", Some("/axes/vector")).unwrap();
    let names = &source.header().variables;
    assert_eq!(names[0], "/axes/vector");
    for absent in ["axes/plane", "axes/line", "axes/text", "axes/vector"] {
        assert!(
            !names.iter().any(|name| name == absent),
            "{absent} in {names:?}"
        );
    }
    assert_eq!(
        names.iter().filter(|name| name.ends_with("times")).count(),
        1,
        "{names:?}"
    );
    let first = open("hdf5/kinds.h5", None).unwrap();
    assert_eq!(first.header().variables.len(), names.len());
    for version in ["earliest", "latest"] {
        let source = open(&format!("hdf5/{version}.h5"), None).unwrap();
        assert_eq!(source.header().variables, ["a", "g/b"], "{version}");
        for (name, count) in [("a", 60), ("g/b", 60)] {
            let source = open(&format!("hdf5/{version}.h5"), Some(name)).unwrap();
            let wanted: Vec<_> = (0..count).map(|n| Some(f64::from(n))).collect();
            assert_eq!(
                values(source.as_ref(), TimeComponent::default()),
                wanted,
                "{version} {name}"
            );
        }
    }
}

#[test]
fn what_is_no_volume_is_refused_by_its_reason() {
    for (name, part) in [
        ("axes/line", "[t, z, y, x, c]"),
        ("axes/many", "sizes [2, 2, 2, 2, 2, 5]"),
        ("axes/text", "no numbers"),
        ("nope", "one of "),
        ("elsewhere/x", "one of "),
    ] {
        let error = message(&open("hdf5/kinds.h5", Some(name)).err().expect(name));
        assert!(error.contains(part), "{name}: {error}");
    }
    let source = open("hdf5/kinds.h5", Some("refused/lzf")).unwrap();
    let error = source.read(TimeComponent::default(), source.header().whole());
    let error = message(&error.expect_err("no voxels"));
    assert!(error.contains("32000, LZF"), "{error}");
}

#[test]
fn a_file_that_was_cut_is_refused() {
    let folder = Folder::new();
    let mut tried = 0;
    for name in ["earliest.h5", "latest.h5", "kinds.h5"] {
        let bytes = std::fs::read(fixtures::path(&format!("hdf5/{name}"))).unwrap();
        let later = (4096..bytes.len()).step_by(997).chain([bytes.len() - 1]);
        for cut in (0..bytes.len().min(4096)).chain(later) {
            let path = folder.write("a.h5", &bytes[..cut]);
            let source =
                stratavox::format::open(&path, &VolumeSelection::default(), &Limits::default());
            assert!(source.is_err(), "{name} cut at {cut}");
            tried += 1;
        }
    }
    println!("{tried} cut files refused");
    assert!(tried > 8000);
}
