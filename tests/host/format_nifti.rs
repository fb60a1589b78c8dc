//! NIfTI files of both versions, single and in pairs: every type, times and components, colors, slopes.
#![cfg(feature = "files")]

use crate::encode;
use crate::files;
use crate::nifti;

use encode::{bytes_of, extremes, gzip};
use files::{Folder, message, numbers};
use nifti::Nifti;
use stratavox::format;
use stratavox::volume::{
    Format, Limits, Rescale, TimeComponent, VolumeSelection, VoxelBox, VoxelType,
};

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
        let source = format::open(
            &folder.write(name, bytes),
            &VolumeSelection::default(),
            &Limits::default(),
        )
        .unwrap();
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
                TimeComponent {
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
            &VolumeSelection::default(),
            &Limits::default(),
        )
        .unwrap();
        assert_eq!(source.header().components, channels);
        assert_eq!(source.header().rescale, Rescale::default());
        for component in 0..channels {
            let pick = TimeComponent { time: 0, component };
            let found = numbers(&source.read(pick, source.header().whole()).unwrap().voxels);
            let first = 10.0 + component as f32;
            assert_eq!(found, [first, first + channels as f32]);
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
