//! Images of microscopes in OME-NGFF 0.4 and 0.5: levels, places, channels, labels.
#![cfg(feature = "zarr")]

use crate::zarr;

use glam::DVec3;
use serde_json::json;
use stratavox::format;
use stratavox::volume::{ComponentKind, Limits, VolumeSelection};
use zarr::{Store, open};

const IMAGES: [&str; 2] = ["ngff-0.4", "ngff-0.5"];

/// The file of the image's metadata, and where in it they stand.
fn metadata(name: &str) -> (&'static str, &'static str) {
    match name {
        "ngff-0.4" => (".zattrs", ""),
        _ => ("zarr.json", "/attributes/ome"),
    }
}

#[test]
fn an_image_has_times_channels_and_places_in_the_files_unit() {
    for name in IMAGES {
        let source = Store::of(name).open().unwrap();
        let header = source.header();
        assert_eq!(header.dims, [12, 8, 4], "{name}");
        assert_eq!((header.times, header.components), (2, 2), "{name}");
        assert_eq!(header.time_names, ["10 second", "10.5 second"], "{name}");
        let center = |index: DVec3| header.world_from_voxel.transform_point3(index + 0.5);
        assert_eq!(center(DVec3::ZERO), DVec3::new(0.0, 0.0, 100.0), "{name}");
        let last = center(DVec3::new(4.0, 2.0, 3.0));
        assert_eq!(last, DVec3::new(1.0, 0.5, 106.0), "{name}");
        let notes = header.notes.join("; ");
        assert!(notes.contains("lengths are in micrometer"), "{notes}");
        assert!(notes.contains("the finest of 3, is read"), "{notes}");
        assert!(notes.contains("--variable labels/cells"), "{notes}");
    }
}

#[test]
fn channels_have_the_names_colours_and_windows_of_the_file() {
    for name in IMAGES {
        let source = Store::of(name).open().unwrap();
        let ComponentKind::Channels(channels) = &source.header().meaning else {
            panic!("{name}: {:?}", source.header().meaning);
        };
        assert_eq!(channels[0].name, "nuclei");
        assert_eq!(channels[0].srgb, Some([0.0, 0.0, 1.0]));
        assert_eq!(channels[0].window, Some([100.0, 9000.0]));
        assert_eq!(channels[1].name, "membrane");
        assert_eq!(channels[1].srgb, Some([0.0, 1.0, 128.0 / 255.0]));
    }
}

#[test]
fn a_level_is_picked_by_its_path_and_keeps_the_images_place() {
    for name in IMAGES {
        let store = Store::of(name);
        let coarse = open(&store.path(), Some("s2")).unwrap();
        let header = coarse.header();
        assert_eq!(header.dims, [3, 2, 4], "{name}");
        assert_eq!(header.variables[0], "s2");
        // The level begins where the finest does: its corner is the same point.
        let corner = header.world_from_voxel.transform_point3(DVec3::ZERO);
        let fine = store.open().unwrap();
        let fine = fine.header().world_from_voxel.transform_point3(DVec3::ZERO);
        assert_eq!(corner, fine, "{name}");
    }
}

#[test]
fn the_finest_level_that_fits_the_limit_is_read_and_said() {
    for name in IMAGES {
        let store = Store::of(name);
        // One time and channel of 16-bit numbers: 768, 192 and 48 bytes; a chunk has 768 in each.
        for (file, place) in [("s1", 1), ("s2", 2)] {
            let key = match name {
                "ngff-0.4" => format!("{file}/.zarray"),
                _ => format!("{file}/zarr.json"),
            };
            store.edit(&key, |array| {
                let sides = array["shape"].clone();
                let chunk = json!([1, 1, sides[2], sides[3], sides[4]]);
                match array.get("chunks") {
                    Some(_) => array["chunks"] = chunk,
                    None => array["chunk_grid"]["configuration"]["chunk_shape"] = chunk,
                }
            });
            let _ = place;
        }
        for (max_bytes, level) in [(768, "s0"), (767, "s1"), (192, "s1"), (191, "s2")] {
            let limits = Limits {
                max_bytes,
                ..Limits::default()
            };
            let source = format::open(&store.path(), &VolumeSelection::default(), &limits).unwrap();
            let header = source.header();
            assert_eq!(header.variables, [level], "{name} {max_bytes}");
            let notes = header.notes.join("; ");
            assert_eq!(notes.contains("needs 768 bytes"), level != "s0", "{notes}");
        }
        let limits = Limits {
            max_bytes: 40,
            ..Limits::default()
        };
        let refused = format::open(&store.path(), &VolumeSelection::default(), &limits).map(|_| ());
        let message = refused.unwrap_err().to_string();
        assert!(
            message.contains("needs 48 bytes, the limit is 40"),
            "{message}"
        );
    }
}

#[test]
fn labels_are_variables_that_are_labels() {
    for name in IMAGES {
        let store = Store::of(name);
        for (variable, dims) in [("labels/cells", [12, 8, 4]), ("labels/cells/s1", [6, 4, 4])] {
            let source = open(&store.path(), Some(variable)).unwrap();
            let header = source.header();
            assert!(header.is_labels, "{name} {variable}");
            assert_eq!(header.dims, dims, "{name} {variable}");
            assert_eq!(header.variables[0], variable, "{name}");
        }
        assert!(!store.open().unwrap().header().is_labels, "{name}");
    }
}

#[test]
fn what_an_image_cannot_say_is_refused_with_the_field() {
    for name in IMAGES {
        let (file, place) = metadata(name);
        let refused = |path: &str, value: serde_json::Value| {
            let store = Store::of(name);
            store.edit(file, |all| {
                *all.pointer_mut(&format!("{place}/multiscales/0{path}"))
                    .expect(path) = value;
            });
            store.refused()
        };
        let transformation = "/datasets/0/coordinateTransformations/0";
        for (path, value, wanted) in [
            (
                "/datasets",
                json!([]),
                "`datasets`: wanted a list of levels",
            ),
            (
                "/datasets/0/path",
                json!("../s0"),
                "`path`: wanted an array of the store",
            ),
            (
                "/datasets/0/path",
                json!("s9"),
                "`path`: wanted an array of the store",
            ),
            (
                "/axes",
                json!(["y", "x"]),
                "`axes`: wanted 5, one an axis of the array",
            ),
            (
                "/axes/2/name",
                json!("x"),
                "`axes`: wanted x, y and z at most once each",
            ),
            (
                transformation,
                json!({"type": "affine", "affine": []}),
                "the transformation `affine` is not supported",
            ),
            (
                "/datasets/0/coordinateTransformations/0/scale",
                json!([1, 1, 1, 1, 0]),
                "`coordinateTransformations`: wanted scales above 0",
            ),
            (
                "/datasets/0/coordinateTransformations/0/scale",
                json!([1, 1]),
                "`coordinateTransformations`: wanted scales above 0",
            ),
            (
                "/datasets/0/coordinateTransformations/0/scale",
                json!([1, 1, 1, 1, 1e200]),
                "`coordinateTransformations`: wanted lengths that span a volume",
            ),
        ] {
            let message = refused(path, value);
            assert!(message.contains(wanted), "{name} {path}: {message}");
        }
    }
}
