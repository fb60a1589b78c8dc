//! Raw voxels: what a spec and a sidecar say, and that the length has to be exact.
#![cfg(feature = "json")]

use crate::encode;
use crate::files;
use crate::truth;

use encode::{bytes_of, extremes};
use files::{Folder, message, numbers};
use glam::dvec3;
use stratavox::format;
use stratavox::format::raw::{self, RawSpec};
use stratavox::volume::{
    Format, Limits, ReadError, Source, TimeComponent, VolumeSelection, VoxelType,
};

fn spec(text: &str) -> RawSpec {
    RawSpec::parse(text).unwrap_or_else(|problem| panic!("{text}: {problem}"))
}

fn all_numbers(source: &dyn Source) -> Vec<f32> {
    numbers(
        &source
            .read(TimeComponent::default(), source.header().whole())
            .unwrap()
            .voxels,
    )
}

fn refusal(found: Result<Box<dyn Source>, ReadError>) -> String {
    message(&found.err().expect("an error"))
}

#[test]
fn a_spec_says_dims_type_spacing_and_byte_order() {
    let plain = RawSpec {
        dims: [256, 128, 109],
        stored: VoxelType::I16,
        spacing: [1.0; 3],
        is_big_endian: false,
        header_bytes: 0,
    };
    assert_eq!(spec("256x128x109,i16"), plain);
    assert_eq!(spec("256x128x109, int16, le"), plain);
    let spaced = RawSpec {
        spacing: [0.9, 0.8, 1.5],
        is_big_endian: true,
        ..plain
    };
    assert_eq!(spec("256x128x109,i16,0.9x0.8x1.5,be"), spaced);
    assert_eq!(spec("256x128x109,i16,be,0.9x0.8x1.5"), spaced);
}

#[test]
fn a_spec_that_cannot_be_is_refused_with_the_word_that_is_wrong() {
    let cases = [
        ("", "`dims`"),
        ("256x256", "`dims`"),
        (
            "256x256x0,u8",
            "`dims`: wanted three numbers above 0: 256x256x109, found `256x256x0`",
        ),
        ("-1x2x3,u8", "`dims`"),
        ("4294967296x1x1,u8", "`dims`"),
        ("2x2x2x2,u8", "`dims`"),
        ("2x2x2", "`type`: wanted one of u8, i8"),
        ("2x2x2,u12", "found `u12`"),
        (
            "2x2x2,u8,middle",
            "wanted a spacing such as 0.9x0.9x1.5, le or be, found `middle`",
        ),
        ("2x2x2,u8,1x1x0", "spacing"),
        ("2x2x2,u8,1x1xnan", "spacing"),
        ("2x2x2,u8,1x1xinf", "spacing"),
        ("2x2x2,u8,le,be", "one byte order"),
        ("2x2x2,u8,1x1x1,2x2x2", "one spacing"),
        ("2x2x2,u8,\u{1b}[2J", "\\u{1b}[2J"),
    ];
    for (text, wanted) in cases {
        let problem = RawSpec::parse(text).expect_err(text).to_string();
        assert!(problem.contains(wanted), "{text}: {problem}");
    }
}

#[test]
fn every_type_and_byte_order_gives_its_numbers() {
    let folder = Folder::new();
    let types = [
        "u8", "i8", "u16", "i16", "u32", "i32", "u64", "i64", "f16", "f32", "f64",
    ];
    for name in types {
        for order in ["le", "be"] {
            let spec = spec(&format!("3x2x1,{name},{order}"));
            let values = extremes(spec.stored);
            let path = folder.write("a.raw", bytes_of(&values, spec.stored, order == "be"));
            let source = raw::open(&path, &spec, &Limits::default()).unwrap();
            assert_eq!(spec.stored.name(), name);
            let wanted: Vec<f32> = match name {
                "f16" => values
                    .iter()
                    .map(|&n| half::f16::from_f64(n as f64).to_f32())
                    .collect(),
                _ => values.iter().map(|&n| n as f32).collect(),
            };
            assert_eq!(all_numbers(&*source), wanted, "{name} {order}");
        }
    }
}

#[test]
fn the_center_of_the_first_voxel_is_the_origin() {
    let folder = Folder::new();
    let path = folder.write("a.raw", [0; 8]);
    let source = raw::open(&path, &spec("2x2x2,u8,0.5x2x3"), &Limits::default()).unwrap();
    let header = source.header();
    assert_eq!(header.format, Format::Raw);
    let center = |x, y, z| {
        header
            .world_from_voxel
            .transform_point3(dvec3(x, y, z) + 0.5)
    };
    assert_eq!(center(0.0, 0.0, 0.0), dvec3(0.0, 0.0, 0.0));
    assert_eq!(center(1.0, 1.0, 1.0), dvec3(0.5, 2.0, 3.0));
}

#[test]
fn a_file_of_any_other_length_is_refused() {
    let folder = Folder::new();
    for (length, wanted) in [
        (0, "found 0"),
        (23, "found 23"),
        (25, "found 25"),
        (48, "found 48"),
    ] {
        let path = folder.write("a.raw", vec![0; length]);
        let refused = refusal(raw::open(&path, &spec("2x2x3,i16"), &Limits::default()));
        assert!(
            refused.contains("promises 24 bytes") && refused.contains(wanted),
            "{refused}"
        );
    }
    let path = folder.write("a.raw", [0; 8]);
    let refused = refusal(raw::open(
        &path,
        &spec("4294967295x4294967295x4294967295,f64"),
        &Limits::default(),
    ));
    assert!(refused.contains("below 2^64"), "{refused}");
    let refused = refusal(raw::open(
        &folder.path("none.raw"),
        &spec("2x2x2,u8"),
        &Limits::default(),
    ));
    assert!(refused.contains("none.raw"), "{refused}");
}

#[test]
fn a_sidecar_is_found_from_the_voxels_and_from_its_own_name() {
    let folder = Folder::new();
    folder.write("a.raw", [9, 9, 9, 0, 1, 0, 2, 0, 3, 0, 4]);
    let sidecar = r#"{"file": "a.raw", "dims": [2, 2, 1], "type": "uint16", "endian": "big",
                      "spacing": [1, 2, 3], "header_bytes": 3}"#;
    folder.write("a.json", sidecar);
    for name in ["a.raw", "a.json"] {
        let source = format::open(
            &folder.path(name),
            &VolumeSelection::default(),
            &Limits::default(),
        )
        .unwrap();
        assert_eq!(all_numbers(&*source), [1.0, 2.0, 3.0, 4.0], "{name}");
        assert_eq!(source.header().dims, [2, 2, 1]);
        assert_eq!(
            source.header().world_from_voxel.matrix3.z_axis,
            dvec3(0.0, 0.0, 3.0)
        );
    }
    folder.write("b.raw", [5]);
    folder.write(
        "b.raw.json",
        r#"{"file": "b.raw", "dims": [1, 1, 1], "type": "u8"}"#,
    );
    let source = format::open(
        &folder.path("b.raw"),
        &VolumeSelection::default(),
        &Limits::default(),
    )
    .unwrap();
    assert_eq!(all_numbers(&*source), [5.0]);
    folder.write("c.raw", [5]);
    let refused = refusal(format::open(
        &folder.path("c.raw"),
        &VolumeSelection::default(),
        &Limits::default(),
    ));
    assert!(
        refused.contains("unknown format") && refused.contains("sidecar"),
        "{refused}"
    );
}

#[test]
fn a_sidecar_that_lies_or_leads_away_is_refused() {
    let folder = Folder::new();
    folder.write("a.raw", [0; 8]);
    let cases = [
        (r#"{"dims": [2,2,2], "type": "u8"}"#, "missing field `file`"),
        (r#"{"file": "a.raw", "type": "u8"}"#, "missing field `dims`"),
        (
            r#"{"file": "a.raw", "dims": [2,2,2], "type": "u8", "spacings": [1,1,1]}"#,
            "spacings",
        ),
        (
            r#"{"file": "a.raw", "dims": [2,2], "type": "u8"}"#,
            "sidecar",
        ),
        (
            r#"{"file": "a.raw", "dims": [2,2,-2], "type": "u8"}"#,
            "sidecar",
        ),
        (
            r#"{"file": "a.raw", "dims": [2,2,0], "type": "u8"}"#,
            "`dims`: wanted three numbers above 0",
        ),
        (
            r#"{"file": "a.raw", "dims": [2,2,2], "type": "u9"}"#,
            "`type`",
        ),
        (
            r#"{"file": "a.raw", "dims": [2,2,1], "type": "u16"}"#,
            "no `endian`",
        ),
        (
            r#"{"file": "a.raw", "dims": [2,2,1], "type": "u16", "endian": "middle"}"#,
            "`endian`",
        ),
        (
            r#"{"file": "a.raw", "dims": [2,2,2], "type": "u8", "spacing": [1,1,0]}"#,
            "`spacing`",
        ),
        (
            r#"{"file": "a.raw", "dims": [2,2,2], "type": "u8", "spacing": [1,1,1e300]}"#,
            "`spacing`",
        ),
        (
            r#"{"file": "a.raw", "dims": [2,2,2], "type": "u8", "header_bytes": 18446744073709551615}"#,
            "promises",
        ),
        (
            r#"{"file": "../a.raw", "dims": [2,2,2], "type": "u8"}"#,
            "`file`",
        ),
        (
            r#"{"file": "/a.raw", "dims": [2,2,2], "type": "u8"}"#,
            "`file`",
        ),
        (r#"{"file": "", "dims": [2,2,2], "type": "u8"}"#, "`file`"),
        (
            r#"{"file": "a.raw", "dims": [2,2,2], "type": "u8""#,
            "sidecar",
        ),
        ("{\"\\u001b[2J\": 1}", "\\u{1b}[2J"),
    ];
    for (text, wanted) in cases {
        let refused = refusal(format::open(
            &folder.write("s.json", text),
            &VolumeSelection::default(),
            &Limits::default(),
        ));
        assert!(refused.contains(wanted), "{text}: {refused}");
    }
    let limits = Limits {
        max_header_bytes: 10,
        ..Limits::default()
    };
    let refused = refusal(format::open(
        &folder.write("s.json", [b' '; 11]),
        &VolumeSelection::default(),
        &limits,
    ));
    assert!(
        refused.contains("the sidecar needs 11 bytes, the limit is 10"),
        "{refused}"
    );
}

#[test]
fn the_walnut_is_the_same_from_its_sidecar_and_from_a_spec() {
    let Some(folder) = truth::folder() else {
        return;
    };
    let of = |name: &str| folder.join("ct-walnut").join(name);
    let by_header = all_numbers(
        &*format::open(
            &of("walnut.mhd"),
            &VolumeSelection::default(),
            &Limits::default(),
        )
        .unwrap(),
    );
    let by_sidecar = format::open(
        &of("walnut.raw"),
        &VolumeSelection::default(),
        &Limits::default(),
    )
    .unwrap();
    assert_eq!(
        by_sidecar.header().world_from_voxel.matrix3.x_axis.x,
        0.015625
    );
    assert!(all_numbers(&*by_sidecar) == by_header, "from the sidecar");
    let by_spec = raw::open(
        &of("walnut.raw"),
        &spec("128x96x114,u16"),
        &Limits::default(),
    )
    .unwrap();
    assert!(all_numbers(&*by_spec) == by_header, "from the spec");
}
