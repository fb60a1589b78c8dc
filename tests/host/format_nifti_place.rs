//! Where the voxels of NIfTI files lie: sform, qform, sizes, units; and real files.
#![cfg(feature = "files")]

use crate::files;
use crate::nifti;
use crate::truth;

use files::Folder;
use glam::{DVec3, dvec3};
use nifti::Nifti;
use stratavox::format;
use stratavox::volume::{Header, Limits, Rescale, Source, Statistics, VolumeSelection};

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

/// Numbers of the manifest against one entry's `Statistics`, over all times.
fn check_statistics(id: &str, source: &dyn Source, stored: &serde_json::Value) {
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
        let source = format::open(&path, &VolumeSelection::default(), &Limits::default())
            .unwrap_or_else(|e| panic!("{id}: {e}"));
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

#[test]
fn a_header_that_was_repaired_is_a_note() {
    let folder = Folder::new();
    let voxels = [0; 12];
    let notes = |file: &Nifti| {
        let (header, _) = folder.read("a.nii", file.with(&voxels)).unwrap();
        header.notes.join("\n")
    };
    let good = Nifti {
        sform_code: 1,
        srow: [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
        ],
        ..Nifti::new(4, 16)
    };
    assert_eq!(notes(&good), "");
    let sizes = |x: f64| [1.0, x, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0];
    for (what, file, words) in [
        (
            "NaN beside an sform",
            Nifti {
                pixdim: sizes(f64::NAN),
                ..good.clone()
            },
            "voxels of NaN x 1 x 1, which cannot be: the sform counts",
        ),
        (
            "0 beside an sform",
            Nifti {
                pixdim: sizes(0.0),
                ..good.clone()
            },
            "voxels of 0 x 1 x 1, which cannot be: the sform counts",
        ),
        (
            "0 without one",
            Nifti {
                pixdim: sizes(0.0),
                ..Nifti::new(4, 16)
            },
            "voxels of 0 x 1 x 1 are taken as 1 x 1 x 1",
        ),
        (
            "a slope",
            Nifti {
                scl_slope: f64::INFINITY,
                ..good.clone()
            },
            "scl_slope is inf: values are taken as they are stored",
        ),
        (
            "an offset",
            Nifti {
                vox_offset: 348.0,
                ..good.clone()
            },
            "vox_offset is 348, inside the header: 352 is taken",
        ),
        (
            "qfac",
            Nifti {
                pixdim: [f64::NAN, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0],
                sform_code: 0,
                qform_code: 1,
                ..good.clone()
            },
            "qfac, pixdim[0], is NaN: 1 is taken",
        ),
    ] {
        let found = notes(&file);
        assert!(found.contains(words), "{what}: {found}");
    }
}
