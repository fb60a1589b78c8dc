//! NIfTI files of both versions, single and in pairs, made here and real ones.
#![cfg(feature = "files")]

#[path = "shared/encode.rs"]
mod encode;
#[path = "shared/files.rs"]
mod files;
#[path = "shared/nifti.rs"]
mod nifti;
#[path = "shared/truth.rs"]
mod truth;

use encode::{bytes_of, extremes, gzip};
use files::{Folder, message, numbers};
use glam::{DVec3, dvec3};
use nifti::Nifti;
use stratavox::format;
use stratavox::volume::{Format, Header, Limits, Pick, Rescale, Statistics, VoxelBox, VoxelType};

const TYPES: [(i16, i16, VoxelType); 10] = [
    (2, 8, VoxelType::U8),
    (4, 16, VoxelType::I16),
    (8, 32, VoxelType::I32),
    (16, 32, VoxelType::F32),
    (64, 64, VoxelType::F64),
    (256, 8, VoxelType::I8),
    (512, 16, VoxelType::U16),
    (768, 32, VoxelType::U32),
    (1024, 64, VoxelType::I64),
    (1280, 64, VoxelType::U64),
];

/// Where the center of a voxel lies.
fn center(header: &Header, x: f64, y: f64, z: f64) -> DVec3 {
    header
        .world_from_voxel
        .transform_point3(dvec3(x, y, z) + 0.5)
}

#[track_caller]
fn same_point(found: DVec3, wanted: DVec3) {
    let error = (found - wanted).length();
    // The numbers of version 1 are f32.
    assert!(error < 1e-5, "{found}, not {wanted}");
}

#[test]
fn every_type_of_both_versions_and_byte_orders_gives_its_numbers_however_it_is_stored() {
    let folder = Folder::new();
    let mut tried = 0;
    for (datatype, bitpix, stored) in TYPES {
        let values = extremes(stored);
        for version in [1, 2] {
            for big_endian in [false, true] {
                let mut header = Nifti::new(datatype, bitpix);
                (header.version, header.big_endian) = (version, big_endian);
                let voxels = bytes_of(&values, stored, big_endian);
                let single = header.with(&voxels);
                header.is_single_file = false;
                for (name, bytes, image) in [
                    ("a.nii", single.clone(), None),
                    ("b.nii.gz", gzip(&single), None),
                    ("c.hdr", header.bytes(), Some(("c.img", voxels.clone()))),
                    ("d.hdr", header.bytes(), Some(("d.img.gz", gzip(&voxels)))),
                    (
                        "e.hdr.gz",
                        gzip(&header.bytes()),
                        Some(("e.img.gz", gzip(&voxels))),
                    ),
                ] {
                    if let Some((name, bytes)) = image {
                        folder.write(name, bytes);
                    }
                    let (found, piece) = folder
                        .read(name, bytes)
                        .unwrap_or_else(|e| panic!("{}", message(&e)));
                    let format = if version == 1 {
                        Format::Nifti1
                    } else {
                        Format::Nifti2
                    };
                    assert_eq!((found.format, found.stored), (format, stored), "{name}");
                    assert_eq!(found.dims, [3, 2, 1]);
                    let wanted: Vec<f32> = values.iter().map(|&n| n as f32).collect();
                    assert_eq!(
                        numbers(&piece.voxels),
                        wanted,
                        "{name} {stored:?} {version} {big_endian}"
                    );
                    tried += 1;
                }
            }
        }
    }
    assert_eq!(tried, 10 * 2 * 2 * 5);
}

#[test]
fn one_time_one_component_and_one_box_can_be_picked() {
    let folder = Folder::new();
    // The number says where it stands: component, time, z, y, x from the left.
    let mut values = Vec::new();
    for c in 0..2_i128 {
        for t in 0..3 {
            for z in 0..2 {
                for y in 0..3 {
                    for x in 0..4 {
                        values.push((((c * 10 + t) * 10 + z) * 10 + y) * 10 + x);
                    }
                }
            }
        }
    }
    let mut header = Nifti::new(512, 16);
    header.dim = [5, 4, 3, 2, 3, 2, 0, 0];
    let bytes = header.with(&bytes_of(&values, VoxelType::U16, false));
    for (name, bytes) in [("a.nii", bytes.clone()), ("a.nii.gz", gzip(&bytes))] {
        let source = format::open(&folder.write(name, bytes), &Limits::default()).unwrap();
        let header = source.header();
        assert_eq!(
            (header.dims, header.times, header.components),
            ([4, 3, 2], 3, 2)
        );
        let region = VoxelBox {
            min: [1, 1, 0],
            max: [3, 3, 2],
        };
        let found = source
            .read(
                Pick {
                    time: 2,
                    component: 1,
                },
                region,
            )
            .unwrap();
        let wanted = [12011, 12012, 12021, 12022, 12111, 12112, 12121, 12122];
        assert_eq!(numbers(&found.voxels), wanted.map(|n| n as f32), "{name}");
    }
}

#[test]
fn colors_are_components_and_have_no_slope() {
    let folder = Folder::new();
    for (datatype, channels) in [(128, 3_u32), (2304, 4)] {
        let mut header = Nifti::new(datatype, 8 * channels as i16);
        header.dim = [3, 2, 1, 1, 0, 0, 0, 0];
        (header.scl_slope, header.scl_inter) = (7.0, 7.0);
        let voxels: Vec<u8> = (10..10 + 2 * channels as u8).collect();
        let source = format::open(
            &folder.write("a.nii", header.with(&voxels)),
            &Limits::default(),
        )
        .unwrap();
        assert_eq!(source.header().components, channels);
        assert_eq!(source.header().rescale, Rescale::default());
        for component in 0..channels {
            let pick = Pick { time: 0, component };
            let found = numbers(&source.read(pick, source.header().whole()).unwrap().voxels);
            let first = 10.0 + component as f32;
            assert_eq!(found, [first, first + channels as f32]);
        }
    }
}

#[test]
fn the_sform_comes_first_then_the_qform_then_the_sizes_alone() {
    let folder = Folder::new();
    for version in [1, 2] {
        let mut header = Nifti::new(2, 8);
        header.version = version;
        header.sform_code = 1;
        header.srow = [
            [0.0, -3.0, 0.5, 10.0],
            [2.0, 0.0, 0.0, 20.0],
            [0.0, 0.25, 4.0, 30.0],
        ];
        header.qform_code = 1;
        // A half turn about z: b = c = 0, d = 1.
        header.quatern = [0.0, 0.0, 1.0];
        header.qoffset = [100.0, 200.0, 300.0];
        header.pixdim = [1.0, 2.0, 3.0, 4.0, 0.0, 0.0, 0.0, 0.0];
        let read = |header: &Nifti| folder.read("a.nii", header.with(&[0; 6])).unwrap().0;

        let found = read(&header);
        same_point(center(&found, 0.0, 0.0, 0.0), dvec3(10.0, 20.0, 30.0));
        same_point(center(&found, 1.0, 0.0, 0.0), dvec3(10.0, 22.0, 30.0));
        same_point(center(&found, 0.0, 1.0, 0.0), dvec3(7.0, 20.0, 30.25));
        same_point(center(&found, 0.0, 0.0, 1.0), dvec3(10.5, 20.0, 34.0));
        assert!(found.notes.is_empty(), "{:?}", found.notes);

        header.sform_code = 0;
        let found = read(&header);
        same_point(center(&found, 0.0, 0.0, 0.0), dvec3(100.0, 200.0, 300.0));
        same_point(center(&found, 1.0, 1.0, 1.0), dvec3(98.0, 197.0, 304.0));

        header.qform_code = 0;
        let found = read(&header);
        same_point(center(&found, 0.0, 0.0, 0.0), DVec3::ZERO);
        same_point(center(&found, 1.0, 1.0, 1.0), dvec3(2.0, 3.0, 4.0));
        assert!(
            found.notes[0].contains("no orientation"),
            "{:?}",
            found.notes
        );
    }
}

#[test]
fn the_quaternion_turns_and_qfac_mirrors() {
    let folder = Folder::new();
    let mut header = Nifti::new(2, 8);
    header.qform_code = 2;
    // A third of a turn about (1, 1, 1): x to y, y to z, z to x; a = b = c = d = 1/2.
    header.quatern = [0.5; 3];
    header.qoffset = [1.0, 2.0, 3.0];
    for (qfac, mirrored) in [(1.0, 1.0), (-1.0, -1.0), (0.0, 1.0)] {
        header.pixdim = [qfac, 2.0, 3.0, 4.0, 0.0, 0.0, 0.0, 0.0];
        let (found, _) = folder.read("a.nii", header.with(&[0; 6])).unwrap();
        same_point(center(&found, 0.0, 0.0, 0.0), dvec3(1.0, 2.0, 3.0));
        same_point(center(&found, 1.0, 0.0, 0.0), dvec3(1.0, 4.0, 3.0));
        same_point(center(&found, 0.0, 1.0, 0.0), dvec3(1.0, 2.0, 6.0));
        same_point(
            center(&found, 0.0, 0.0, 1.0),
            dvec3(1.0 + 4.0 * mirrored, 2.0, 3.0),
        );
        assert_eq!(
            found.world_from_voxel.matrix3.determinant().signum(),
            mirrored,
            "qfac {qfac}"
        );
    }
    // Half a turn about x + y, with the rounding of f32: a is 0, not the root of a negative number.
    let half_turn = f64::from(std::f32::consts::FRAC_1_SQRT_2);
    header.quatern = [half_turn, half_turn, 0.0];
    header.pixdim = [1.0; 8];
    let (found, _) = folder.read("a.nii", header.with(&[0; 6])).unwrap();
    same_point(center(&found, 1.0, 0.0, 0.0), dvec3(1.0, 3.0, 3.0));
    same_point(center(&found, 0.0, 0.0, 1.0), dvec3(1.0, 2.0, 2.0));
}

#[test]
fn a_form_that_spans_no_volume_is_passed_over_and_said() {
    let folder = Folder::new();
    let mut header = Nifti::new(2, 8);
    (header.sform_code, header.qform_code) = (1, 1);
    header.srow = [
        [1.0, 0.0, 0.0, 9.0],
        [0.0, 1.0, 0.0, 9.0],
        [0.0, 0.0, 0.0, 9.0],
    ];
    header.qoffset = [5.0, 6.0, 7.0];
    let (found, _) = folder.read("a.nii", header.with(&[0; 6])).unwrap();
    same_point(center(&found, 0.0, 0.0, 0.0), dvec3(5.0, 6.0, 7.0));
    assert!(
        found.notes[0].contains("sform spans no volume"),
        "{:?}",
        found.notes
    );
    header.qoffset = [f64::NAN; 3];
    let (found, _) = folder.read("a.nii", header.with(&[0; 6])).unwrap();
    same_point(center(&found, 0.0, 0.0, 0.0), DVec3::ZERO);
    header.pixdim = [1.0, -2.0, f64::NAN, 0.0, 0.0, 0.0, 0.0, 0.0];
    let (found, _) = folder.read("a.nii", header.with(&[0; 6])).unwrap();
    same_point(center(&found, 1.0, 1.0, 1.0), dvec3(2.0, 1.0, 1.0));
    assert!(
        found.notes.iter().any(|note| note.contains("-2 x NaN x 0")),
        "{:?}",
        found.notes
    );
}

#[test]
fn lengths_become_millimetres() {
    let folder = Folder::new();
    for (units, wanted, noted) in [
        (0, 2.0, false),
        (1, 2000.0, true),
        (2, 2.0, false),
        (3, 0.002, true),
        (2 + 8, 2.0, false),
    ] {
        for form in [false, true] {
            let mut header = Nifti::new(2, 8);
            header.units = units;
            header.pixdim = [1.0, 2.0, 2.0, 2.0, 0.0, 0.0, 0.0, 0.0];
            header.sform_code = i16::from(form);
            header.srow = [
                [2.0, 0.0, 0.0, 2.0],
                [0.0, 2.0, 0.0, 0.0],
                [0.0, 0.0, 2.0, 0.0],
            ];
            let (found, _) = folder.read("a.nii", header.with(&[0; 6])).unwrap();
            let origin = center(&found, 0.0, 0.0, 0.0);
            let step = center(&found, 1.0, 0.0, 0.0) - origin;
            assert!(
                (step.x / wanted - 1.0).abs() < 1e-12,
                "unit {units}: {step}"
            );
            let shift = if form { wanted } else { 0.0 };
            assert!(
                (origin.x - shift).abs() < 1e-9,
                "unit {units}: origin {origin}"
            );
            let is_noted = found
                .notes
                .iter()
                .any(|note| note.contains("converted to millimetres"));
            assert_eq!(is_noted, noted, "unit {units}: {:?}", found.notes);
        }
    }
}

#[test]
fn a_slope_counts_where_it_is_a_number_other_than_zero() {
    let folder = Folder::new();
    let cases = [
        (2.0, -5.0, (2.0, -5.0)),
        (-0.5, 0.0, (-0.5, 0.0)),
        (0.0, 9.0, (1.0, 0.0)),
        (f64::NAN, 9.0, (1.0, 0.0)),
        (f64::INFINITY, 9.0, (1.0, 0.0)),
        (2.0, f64::NAN, (2.0, 0.0)),
    ];
    for (scl_slope, scl_inter, (slope, intercept)) in cases {
        let header = Nifti {
            scl_slope,
            scl_inter,
            ..Nifti::new(4, 16)
        };
        let (found, _) = folder.read("a.nii", header.with(&[0; 12])).unwrap();
        assert_eq!(
            found.rescale,
            Rescale { slope, intercept },
            "{scl_slope} {scl_inter}"
        );
    }
}

#[test]
fn voxels_begin_where_vox_offset_says_and_never_inside_the_header() {
    let folder = Folder::new();
    let voxels = [1_u8, 2, 3, 4, 5, 6];
    for (version, offset, gap) in [
        (1, 0.0, 0),
        (1, 348.0, 0),
        (1, 352.0, 0),
        (1, 400.0, 48),
        (2, 0.0, 0),
        (2, 544.0, 0),
        (2, 560.0, 16),
    ] {
        let header = Nifti {
            version,
            vox_offset: offset,
            ..Nifti::new(2, 8)
        };
        // An extension lies between.
        let bytes = [header.bytes(), vec![99; gap], voxels.to_vec()].concat();
        for (name, bytes) in [("a.nii", bytes.clone()), ("a.nii.gz", gzip(&bytes))] {
            let (_, piece) = folder.read(name, bytes).unwrap();
            assert_eq!(
                numbers(&piece.voxels),
                [1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
                "{name} at {offset}"
            );
        }
    }
    let header = Nifti {
        is_single_file: false,
        vox_offset: 3.0,
        ..Nifti::new(2, 8)
    };
    folder.write("p.img", [&[7, 7, 7][..], &voxels].concat());
    let (_, piece) = folder.read("p.hdr", header.bytes()).unwrap();
    assert_eq!(numbers(&piece.voxels), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    for (version, offset) in [
        (1, f64::NAN),
        (1, f64::INFINITY),
        (1, -352.0),
        (1, 352.5),
        (2, -1.0),
        (2, 100.0),
    ] {
        let header = Nifti {
            version,
            vox_offset: offset,
            ..Nifti::new(2, 8)
        };
        let refused = folder.refused("a.nii", header.with(&voxels));
        assert!(refused.contains("vox_offset"), "{offset}: {refused}");
    }
}

#[test]
fn either_file_of_a_pair_opens_it() {
    let folder = Folder::new();
    let header = Nifti {
        is_single_file: false,
        ..Nifti::new(2, 8)
    };
    // The first two bytes are those of gzip: in an `.img` that means nothing.
    let voxels = [0x1f, 0x8b, 3, 4, 5, 6];
    for (hdr, img) in [
        ("a.hdr", "a.img"),
        ("B.HDR", "B.IMG"),
        ("c.x.hdr", "c.x.img"),
    ] {
        folder.write(hdr, header.bytes());
        let (_, piece) = folder
            .read(img, voxels)
            .unwrap_or_else(|e| panic!("{}", message(&e)));
        assert_eq!(numbers(&piece.voxels)[..3], [31.0, 139.0, 3.0], "{img}");
    }
    let refused = folder.refused("alone.hdr", header.bytes());
    assert!(
        refused.contains("alone.hdr") && refused.contains("`.img` file beside it"),
        "{refused}"
    );
    let refused = folder.refused("lonely.img", voxels);
    assert!(refused.contains("`.hdr` file beside it"), "{refused}");
}

#[test]
fn what_a_header_cannot_say_is_refused_by_name() {
    let folder = Folder::new();
    let base = Nifti::new(2, 8);
    let cases = [
        (
            Nifti {
                datatype: 32,
                ..base.clone()
            },
            "datatype 32 (complex of two f32) is not supported",
        ),
        (
            Nifti {
                datatype: 1536,
                ..base.clone()
            },
            "128-bit float",
        ),
        (
            Nifti {
                datatype: 1792,
                ..base.clone()
            },
            "complex",
        ),
        (
            Nifti {
                datatype: 2048,
                ..base.clone()
            },
            "complex",
        ),
        (
            Nifti {
                datatype: 1,
                ..base.clone()
            },
            "one bit a voxel",
        ),
        (
            Nifti {
                datatype: 0,
                ..base.clone()
            },
            "unknown",
        ),
        (
            Nifti {
                datatype: 3,
                ..base.clone()
            },
            "`datatype`: wanted a number that nifti1.h lists",
        ),
        (
            Nifti {
                dim: [0, 3, 2, 1, 0, 0, 0, 0],
                ..base.clone()
            },
            "`dim[0]`: wanted 1 to 7, found `0`",
        ),
        (
            Nifti {
                dim: [8, 3, 2, 1, 1, 1, 1, 1],
                ..base.clone()
            },
            "`dim[0]`",
        ),
        (
            Nifti {
                dim: [-1, 3, 2, 1, 1, 1, 1, 1],
                ..base.clone()
            },
            "`dim[0]`",
        ),
        (
            Nifti {
                dim: [3, 3, 0, 1, 0, 0, 0, 0],
                ..base.clone()
            },
            "`dim[2]`: wanted 1 to 2^32 - 1, found `0`",
        ),
        (
            Nifti {
                dim: [3, 3, -2, 1, 0, 0, 0, 0],
                ..base.clone()
            },
            "`dim[2]`",
        ),
        (
            Nifti {
                version: 2,
                dim: [200, 3, 2, 1, 0, 0, 0, 0],
                ..base.clone()
            },
            "`dim[0]`",
        ),
        (
            Nifti {
                version: 2,
                dim: [3, 1 << 40, 2, 1, 0, 0, 0, 0],
                ..base.clone()
            },
            "`dim[1]`",
        ),
        (
            Nifti {
                dim: [7, 32767, 32767, 32767, 32767, 32767, 32767, 32767],
                ..base.clone()
            },
            "components",
        ),
        (
            Nifti {
                dim: [4, 32767, 32767, 32767, 32767, 0, 0, 0],
                ..base.clone()
            },
            "promises",
        ),
    ];
    for (header, wanted) in cases {
        let refused = folder.refused("a.nii", header.with(&[0; 6]));
        assert!(refused.contains(wanted), "{wanted}: {refused}");
    }
    let mut analyze = base.with(&[0; 6]);
    analyze[344..348].fill(0);
    let refused = folder.refused("a.nii", &analyze);
    assert!(
        refused.contains("Analyze 7.5") && refused.contains("not supported"),
        "{refused}"
    );
    let mut transferred = Nifti {
        version: 2,
        ..base.clone()
    }
    .with(&[0; 6]);
    transferred[8] = b'\n';
    let refused = folder.refused("a.nii", &transferred);
    assert!(refused.contains("`magic`"), "{refused}");
}

#[test]
fn bytes_that_are_missing_are_never_voxels() {
    let folder = Folder::new();
    for version in [1, 2] {
        let whole = Nifti {
            version,
            ..Nifti::new(4, 16)
        }
        .with(&[1; 12]);
        for (name, whole) in [("a.nii", whole.clone()), ("a.nii.gz", gzip(&whole))] {
            assert!(folder.read(name, &whole).is_ok());
            for length in 0..whole.len() {
                let found = folder.read(name, &whole[..length]);
                assert!(
                    found.is_err(),
                    "{length} of {} bytes of {name} were read",
                    whole.len()
                );
            }
        }
        // Bytes behind the voxels are said.
        let (header, _) = folder.read("a.nii", [whole, vec![0; 5]].concat()).unwrap();
        assert!(
            header.notes[header.notes.len() - 1].contains("5 bytes"),
            "{:?}",
            header.notes
        );
    }
}

#[test]
fn a_wrong_bitpix_is_said_and_the_datatype_counts() {
    let folder = Folder::new();
    let (header, _) = folder
        .read("a.nii", Nifti::new(4, 8).with(&[0; 12]))
        .unwrap();
    assert!(
        header.notes.iter().any(|note| note.contains("bitpix is 8")),
        "{:?}",
        header.notes
    );
}

/// Numbers of the manifest against one entry's `Statistics`, over all times.
fn check_statistics(id: &str, source: &dyn stratavox::volume::Source, stored: &serde_json::Value) {
    let found = Statistics::of(source, 0..1, &Limits::default()).unwrap();
    // No file here has a slope, so values are stored numbers.
    assert_eq!(source.header().rescale, Rescale::default(), "{id}");
    assert_eq!(Some(found.min), stored["min"].as_f64(), "{id}: minimum");
    assert_eq!(Some(found.max), stored["max"].as_f64(), "{id}: maximum");
    let wanted = stored["mean"].as_f64().unwrap();
    // Sums of 16-bit integers are exact; those of f32 round by 2^-53 of the sum at each of 2^22 additions.
    let tolerance = if source.header().stored.is_float() {
        1e-9
    } else {
        1e-12
    };
    let error = (found.mean - wanted).abs();
    assert!(
        error <= tolerance * wanted,
        "{id}: mean {}, not {wanted}",
        found.mean
    );
}

#[test]
fn real_files_have_the_numbers_and_places_of_the_manifest() {
    let entries = truth::entries("nifti");
    for entry in &entries {
        let id = entry["id"].as_str().unwrap();
        let path = truth::folder()
            .unwrap()
            .join(entry["path"].as_str().unwrap());
        let source =
            format::open(&path, &Limits::default()).unwrap_or_else(|e| panic!("{id}: {e}"));
        let volume = &entry["volume"];
        let header = source.header();
        println!("{id}: {header:?}");
        let mut dims = header.dims.to_vec();
        if header.times > 1 {
            dims.push(header.times);
        }
        assert_eq!(serde_json::Value::from(dims), volume["dims_xyz"], "{id}");
        let affine = volume["affine_ras"].as_array().unwrap();
        let wanted: [[f64; 4]; 3] = std::array::from_fn(|row| {
            std::array::from_fn(|column| affine[row][column].as_f64().unwrap())
        });
        let [first, x, y, z] = [
            (0.0, 0.0, 0.0),
            (1.0, 0.0, 0.0),
            (0.0, 1.0, 0.0),
            (0.0, 0.0, 1.0),
        ]
        .map(|(x, y, z)| center(header, x, y, z));
        let found = std::array::from_fn(|row| {
            [
                (x - first)[row],
                (y - first)[row],
                (z - first)[row],
                first[row],
            ]
        });
        // The manifest has six decimals.
        truth::same_affine(id, found, wanted, 2e-6);
        check_statistics(id, &*source, &volume["stored"]);
        if header.times == 1 {
            truth::check(entry, None);
        }
    }
    if !entries.is_empty() {
        assert_eq!(entries.len(), 6);
    }
}
