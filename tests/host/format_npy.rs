//! NumPy arrays: what numpy reads out of them (tests/fixtures/npy), and what is refused.
#![cfg(feature = "files")]

use crate::files;

use files::{Folder, numbers};
use serde_json::Value;
use std::path::{Path, PathBuf};
use stratavox::format;
use stratavox::volume::{
    ComponentKind, Format, Limits, Source, TimeComponent, VolumeSelection, VoxelBox,
};

fn fixtures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/npy")
}

fn open(name: &str) -> Box<dyn Source> {
    format::open(
        &fixtures().join(name),
        &VolumeSelection::default(),
        &Limits::default(),
    )
    .unwrap_or_else(|error| panic!("{name}: {}", files::message(&error)))
}

fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(fixtures().join(name)).unwrap()
}

#[test]
fn every_type_order_and_shape_holds_what_numpy_reads() {
    let text = std::fs::read_to_string(fixtures().join("expected.json")).unwrap();
    let table: serde_json::Map<String, Value> = serde_json::from_str(&text).unwrap();
    for (name, row) in &table {
        let source = open(name);
        let header = source.header();
        assert_eq!(header.format, Format::Npy, "{name}");
        assert_eq!(Value::from(header.dims.to_vec()), row["dims"], "{name}");
        assert_eq!(Value::from(header.times), row["times"], "{name}");
        assert_eq!(Value::from(header.components), row["components"], "{name}");
        assert_eq!(Value::from(header.stored.name()), row["stored"], "{name}");
        // Nothing is said of space: it is that of voxels, the corner of the grid at 0.
        assert_eq!(header.world_from_voxel, glam::DAffine3::IDENTITY, "{name}");
        let meaning = match row["meaning"].as_str() {
            Some("rgb") => ComponentKind::Rgb,
            Some("rgba") => ComponentKind::Rgba,
            _ => ComponentKind::Numbers,
        };
        assert_eq!(header.meaning, meaning, "{name}");
        let mut found = Vec::new();
        for time in 0..header.times {
            for component in 0..header.components {
                let piece = source
                    .read(TimeComponent { time, component }, header.whole())
                    .unwrap();
                assert!(piece.loss.is_none(), "{name}: {:?}", piece.loss);
                let (mut sum, mut weighted) = (0.0, 0.0);
                for (index, number) in numbers(&piece.voxels).into_iter().enumerate() {
                    sum += f64::from(number);
                    weighted += f64::from(number) * (index + 1) as f64;
                }
                found.push(serde_json::json!({ "sum": sum, "weighted": weighted }));
            }
        }
        assert_eq!(
            Value::from(found),
            row["volumes"],
            "{name}: {:?}",
            header.notes
        );
    }
    println!("{} files", table.len());
    assert!(table.len() > 30, "only {} files", table.len());
}

#[test]
fn the_notes_say_how_axes_were_taken() {
    for (name, words) in [
        ("u2-be.npy", "the axes of the array are taken as [z, y, x]"),
        (
            "fortran-i2-be.npy",
            "the axes of the array are taken as [z, y, x]",
        ),
        ("fortran-i2-be.npy", "the array is in Fortran order"),
        ("times.npy", "[t, z, y, x]"),
        ("channels.npy", "[t, c, z, y, x]"),
        ("picture.npy", "[y, x, color]"),
        ("bool.npy", "booleans are read as 0 and 1"),
    ] {
        let source = open(name);
        let notes = source.header().notes.join("\n");
        assert!(notes.contains(words), "{name}: {notes}");
    }
}

#[test]
fn the_order_of_memory_changes_nothing_but_a_note() {
    for name in ["i2-be", "plane", "times", "channels", "picture", "colors"] {
        let [c, fortran] =
            [format!("{name}.npy"), format!("fortran-{name}.npy")].map(|name| open(&name));
        let (header, other) = (c.header(), fortran.header());
        let mut without_note = other.clone();
        without_note.notes.retain(|note| !note.contains("Fortran"));
        assert_eq!(*header, without_note, "{name}");
        assert_eq!(header.notes.len() + 1, other.notes.len(), "{name}");
        for time in 0..header.times {
            for component in 0..header.components {
                let pick = TimeComponent { time, component };
                let read = |source: &dyn Source| source.read(pick, header.whole()).unwrap();
                let bytes = |source: &dyn Source| source.read_bytes(pick, header.whole()).unwrap();
                assert_eq!(read(c.as_ref()), read(fortran.as_ref()), "{name} {pick:?}");
                assert_eq!(
                    bytes(c.as_ref()),
                    bytes(fortran.as_ref()),
                    "{name} {pick:?}"
                );
            }
        }
    }
}

#[test]
fn a_box_of_a_fortran_array_is_that_part_of_the_whole() {
    let source = open("fortran-times.npy");
    let pick = TimeComponent {
        time: 2,
        component: 0,
    };
    let whole = numbers(&source.read(pick, source.header().whole()).unwrap().voxels);
    let region = VoxelBox {
        min: [1, 2, 1],
        max: [4, 4, 2],
    };
    let found = numbers(&source.read(pick, region).unwrap().voxels);
    // 5 x 4 x 2 voxels: the second layer begins at 20.
    let wanted = [&whole[20 + 11..20 + 14], &whole[20 + 16..20 + 19]].concat();
    assert_eq!(found, wanted);
}

#[test]
fn arrays_that_are_no_volumes_are_refused_by_what_they_are() {
    let folder = Folder::new();
    for (name, words) in [
        ("refused-record.npy", "an array of records"),
        ("refused-complex.npy", "complex numbers (descr `<c8`)"),
        ("refused-text.npy", "text"),
        ("refused-date.npy", "dates and durations"),
        ("refused-object.npy", "Python objects"),
        ("refused-long.npy", "floats of more than 64 bits"),
        ("refused-line.npy", "wanted 2 to 5 axes, found `(6)`"),
        (
            "refused-empty.npy",
            "wanted sizes from 1 to 2^32 - 1, found `(2, 0, 3)`",
        ),
    ] {
        let message = folder.refused("a.npy", bytes(name));
        assert!(message.contains(words), "{name}: {message}");
    }
}

/// A version 1 file with this header and eight bytes of data.
fn with_header(header: &str) -> Vec<u8> {
    let mut file = b"\x93NUMPY\x01\0".to_vec();
    file.extend((header.len() as u16).to_le_bytes());
    file.extend(header.bytes());
    file.extend([7; 8]);
    file
}

#[test]
fn a_header_that_lies_is_refused_before_anything_is_allocated() {
    let folder = Folder::new();
    let good = "{'descr': '|u1', 'fortran_order': False, 'shape': (2, 2, 2), }";
    folder.read("a.npy", with_header(good)).unwrap();
    let mut refused = 0;
    for shape in [
        "(2, 2, 3)",
        "(65535, 65535, 65535)",
        "(4294967295, 4294967295, 4294967295)",
        "(4294967296, 2, 2)",
        "(18446744073709551616, 2)",
        "(99999999999999999999999999, 2)",
        "(0, 2, 2)",
        "(2)",
        "()",
        "(2, 2, 2, 2, 2, 2)",
        "(-2, 2, 2)",
        "(2.0, 2, 2)",
        "(nan, 2)",
    ] {
        let text = good.replace("(2, 2, 2)", shape);
        let message = folder.refused("a.npy", with_header(&text));
        assert!(message.contains("npy"), "{shape}: {message}");
        refused += 1;
    }
    for descr in [
        "'>u3'", "'|u2'", "'=u1'", "'u1'", "''", "'é1'", "\"<f4", "b'|u1'", "None",
    ] {
        let text = good.replace("'|u1'", descr);
        let message = folder.refused("a.npy", with_header(&text));
        assert!(message.contains("npy"), "{descr}: {message}");
        refused += 1;
    }
    for (at, byte, words) in [
        (6, 4, "version"),
        (7, 1, "version"),
        (9, 200, "header length"),
    ] {
        let mut file = with_header(good);
        file[at] = byte;
        let message = folder.refused("a.npy", file);
        assert!(message.contains(words), "{message}");
        refused += 1;
    }
    // A length of 4 GiB in version 2.
    let mut file = b"\x93NUMPY\x02\0\xff\xff\xff\xff".to_vec();
    file.extend(good.bytes());
    let message = folder.refused("a.npy", file);
    assert!(message.contains("the limit is"), "{message}");
    println!("{} headers refused", refused + 1);
}

#[test]
fn an_array_cut_anywhere_is_an_error() {
    let folder = Folder::new();
    let mut cuts = 0;
    for name in ["u2-be.npy", "v3.npy", "colors.npy", "fortran-i2-be.npy"] {
        let whole = bytes(name);
        folder.read("a.npy", &whole).unwrap();
        for cut in 0..whole.len() {
            folder.refused("a.npy", &whole[..cut]);
            cuts += 1;
        }
    }
    println!("{cuts} cuts");
}
