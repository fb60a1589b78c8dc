//! TIFF files of an independent writer, and what that writer itself reads out of them (tests/fixtures/tiff).
#![cfg(feature = "tiff")]

use crate::files;
use crate::truth;

use files::numbers;
use serde_json::Value;
use std::path::{Path, PathBuf};
use stratavox::format;
use stratavox::volume::{
    ComponentKind, Format, Header, Limits, Source, TimeComponent, VolumeSelection, VoxelBox, Voxels,
};

fn fixtures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/tiff")
}

/// What the producer found in each file.
fn expected() -> Vec<(String, Value)> {
    let text = std::fs::read_to_string(fixtures().join("expected.json")).unwrap();
    let table: serde_json::Map<String, Value> = serde_json::from_str(&text).unwrap();
    table.into_iter().collect()
}

/// `file.tif#image`.
fn open(name: &str) -> Box<dyn Source> {
    let (file, image) = match name.split_once('#') {
        Some((file, image)) => (file, Some(image.to_owned())),
        None => (name, None),
    };
    let wanted = VolumeSelection {
        variable: image,
        ..VolumeSelection::default()
    };
    format::open(&fixtures().join(file), &wanted, &Limits::default())
        .unwrap_or_else(|error| panic!("{name}: {}", files::message(&error)))
}

/// Sum, sum times place, minimum, maximum.
fn sums(voxels: &Voxels) -> [f64; 4] {
    let (mut sum, mut weighted) = (0.0, 0.0);
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for (index, number) in numbers(voxels).into_iter().map(f64::from).enumerate() {
        sum += number;
        weighted += number * (index + 1) as f64;
        least = least.min(number);
        most = most.max(number);
    }
    [sum, weighted, least, most]
}

fn steps(header: &Header) -> [f64; 3] {
    let affine = header.world_from_voxel;
    [0, 1, 2].map(|k| affine.matrix3.col(k).length())
}

/// Every volume of one file against the table's row.
fn compare_numbers(name: &str, row: &Value, source: &dyn Source) -> usize {
    let header = source.header();
    let corner = header.world_from_voxel.translation;
    assert!(
        corner.length() < 1e-9,
        "{name}: the grid starts at {corner}"
    );
    let mut compared = 0;
    let volumes = row["volumes"].as_array().unwrap().iter();
    let picks = (0..header.times).flat_map(|time| {
        (0..header.components).map(move |component| TimeComponent { time, component })
    });
    let picks: Vec<TimeComponent> = picks.collect();
    assert_eq!(picks.len(), volumes.len(), "{name}");
    let mut all = Vec::new();
    for (pick, volume) in picks.into_iter().zip(volumes) {
        let piece = source
            .read(pick, header.whole())
            .unwrap_or_else(|error| panic!("{name} {pick:?}: {}", files::message(&error)));
        assert!(piece.loss.is_none(), "{name}: {:?}", piece.loss);
        all.extend(numbers(&piece.voxels).into_iter().map(f64::from));
        compared += piece.voxels.len();
        if row["numbers"].is_array() {
            continue;
        }
        let found = sums(&piece.voxels);
        let wanted = ["sum", "weighted", "min", "max"].map(|key| volume[key].as_f64().unwrap());
        assert_eq!(found, wanted, "{name} {pick:?}: {:?}", header.notes);
    }
    if let Some(wanted) = row["numbers"].as_array() {
        // Two decoders of JPEG may differ in each of: the inverse transform by 1 (ITU-T T.83), and the three
        // roundings to RGB of sums with weights below 2.
        let most = if header.components == 3 { 4.0 } else { 1.0 };
        assert_eq!(all.len(), wanted.len(), "{name}");
        for (index, (found, wanted)) in all.iter().zip(wanted).enumerate() {
            let off = (found - wanted.as_f64().unwrap()).abs();
            assert!(off <= most, "{name} at {index}: {found}, not {wanted}");
        }
    }
    compared
}

#[test]
fn every_variant_holds_what_its_writer_reads() {
    let (mut files, mut compared) = (0, 0);
    for (name, row) in expected() {
        let source = open(&name);
        let header = source.header();
        println!("{name}: {:?} {:?}", header.dims, header.notes);
        assert_eq!(header.format, Format::Tiff, "{name}");
        assert_eq!(Value::from(header.dims.to_vec()), row["dims"], "{name}");
        assert_eq!(Value::from(header.times), row["times"], "{name}");
        assert_eq!(Value::from(header.components), row["components"], "{name}");
        assert_eq!(Value::from(header.stored.name()), row["stored"], "{name}");
        let wanted = row["rescale"].as_array();
        let wanted = wanted.map_or([1.0, 0.0], |r| {
            [r[0].as_f64().unwrap(), r[1].as_f64().unwrap()]
        });
        assert_eq!(
            [header.rescale.slope, header.rescale.intercept],
            wanted,
            "{name}"
        );
        match row["meaning"].as_str() {
            Some("rgb") => assert_eq!(header.meaning, ComponentKind::Rgb, "{name}"),
            Some("rgba") => assert_eq!(header.meaning, ComponentKind::Rgba, "{name}"),
            _ if name.starts_with("samples") => assert_eq!(header.meaning, ComponentKind::Numbers),
            _ if header.components > 1 => {
                assert!(
                    matches!(header.meaning, ComponentKind::Channels(_)),
                    "{name}"
                );
            }
            _ => assert_eq!(header.meaning, ComponentKind::Numbers, "{name}"),
        }
        if let Some(wanted) = row["steps"].as_array() {
            for (found, wanted) in steps(header).into_iter().zip(wanted) {
                let off = (found - wanted.as_f64().unwrap()).abs();
                assert!(off < 1e-12, "{name}: {:?}", steps(header));
            }
        }
        if row["time_names"].is_array() {
            assert_eq!(
                Value::from(header.time_names.clone()),
                row["time_names"],
                "{name}"
            );
        }
        if row["variables"].is_array() {
            assert_eq!(
                Value::from(header.variables.clone()),
                row["variables"],
                "{name}"
            );
        }
        if let Some(wanted) = row["channels"].as_array() {
            let ComponentKind::Channels(channels) = &header.meaning else {
                panic!("{name}: {:?}", header.meaning);
            };
            assert_eq!(channels.len(), wanted.len(), "{name}");
            for (channel, wanted) in channels.iter().zip(wanted) {
                assert_eq!(wanted[0], channel.name, "{name}");
                let srgb: Vec<f64> = channel.srgb.unwrap().map(f64::from).to_vec();
                let wanted: Vec<f64> = (0..3).map(|k| wanted[1][k].as_f64().unwrap()).collect();
                assert_eq!(srgb, wanted, "{name}");
            }
        }
        compared += compare_numbers(&name, &row, &*source);
        files += 1;
    }
    println!("{files} files, {compared} numbers");
    assert!(files > 50, "only {files} files");
}

#[test]
fn a_box_holds_the_same_numbers_as_the_whole() {
    let mut boxes = 0;
    for (name, _) in expected() {
        let source = open(&name);
        let header = source.header();
        let [w, h, d] = header.dims;
        let pick = TimeComponent {
            time: header.times - 1,
            component: header.components - 1,
        };
        let whole = numbers(&source.read(pick, header.whole()).unwrap().voxels);
        for (min, max) in [
            ([w / 3, h / 3, d / 2], [w, h, d]),
            ([0, h / 2, 0], [w - w / 4, h / 2 + 1, d]),
            ([w - 1, h - 1, d - 1], [w, h, d]),
        ] {
            let region = VoxelBox { min, max };
            let found = numbers(&source.read(pick, region).unwrap().voxels);
            let mut wanted = Vec::new();
            for z in min[2]..max[2] {
                for y in min[1]..max[1] {
                    for x in min[0]..max[0] {
                        wanted.push(whole[((z * h + y) * w + x) as usize]);
                    }
                }
            }
            assert_eq!(found, wanted, "{name} {region:?}");
            boxes += 1;
        }
    }
    println!("{boxes} boxes");
}

#[test]
fn real_stacks_are_what_the_manifest_says() {
    for entry in truth::entries("tiff") {
        let affine = truth::check(&entry, None);
        if entry["id"] == "tiff-beads" {
            let steps = [affine[0][0], affine[1][1], affine[2][2]];
            // 44.460534 pixels per micrometre, and the spacing that ImageJ wrote.
            assert_eq!(steps, [1.0 / 44.460_534, 1.0 / 44.460_534, 0.125]);
        }
    }
}

#[test]
fn a_note_says_what_was_taken_for_granted() {
    for (name, part) in [
        ("raw-u2-le.tif", "gives no spacing: 1 is taken"),
        (
            "thumbnails.tif",
            "2 pages (the first is page 1) are smaller copies",
        ),
        ("thumbnails.tif", "lengths are in mm"),
        ("imagej-hyper.tif", "lengths are in um"),
        (
            "imagej-contiguous.tif",
            "only the first page has a directory",
        ),
        ("palette-u1.tif", "colors of a map"),
        ("white-is-zero.tif", "values are turned round"),
        ("rgba-associated.tif", "seen as over black"),
        ("slices", "from `s0.tif` to `s10.tif`"),
        ("raw-f8-be.tif", "stored as f64 and kept as f32"),
    ] {
        let source = open(name);
        let notes = source.header().notes.join("\n");
        assert!(notes.contains(part), "{name}: {notes}");
        assert_eq!(
            notes.matches("kept as f32").count(),
            usize::from(name == "raw-f8-be.tif")
        );
    }
}
