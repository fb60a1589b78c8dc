//! NIfTI headers that lie, files that are cut, and where voxels may begin.
#![cfg(feature = "files")]

use crate::encode;
use crate::files;
use crate::nifti;

use encode::gzip;
use files::{Folder, numbers};
use nifti::Nifti;

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
