//! What the numbers of a voxel are to each other, as NIfTI, NRRD and MetaImage say it.

#![cfg(feature = "files")]

use crate::nifti::Nifti;
use std::path::PathBuf;
use stratavox::format::open;
use stratavox::volume::{ComponentKind, Header, Limits, VolumeSelection};

/// A file in a folder that is gone with the first.
fn file(name: &str, bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("a file");
    (folder, path)
}

fn header_of(name: &str, bytes: &[u8]) -> Header {
    let (_folder, path) = file(name, bytes);
    let source = open(&path, &VolumeSelection::default(), &Limits::default());
    let source = source.unwrap_or_else(|error| panic!("{name}: {error}"));
    source.header().clone()
}

#[test]
fn nifti_says_it_by_datatype_and_intent() {
    for (datatype, bits, components, intent, wanted) in [
        (128, 24, 1, 0, ComponentKind::Rgb),
        (2304, 32, 1, 0, ComponentKind::Rgba),
        (16, 32, 3, 1007, ComponentKind::Vector),
        (16, 32, 2, 1006, ComponentKind::Vector),
        (2, 8, 3, 2003, ComponentKind::Rgb),
        (2, 8, 4, 2004, ComponentKind::Rgba),
        (16, 32, 3, 0, ComponentKind::Numbers),
        (16, 32, 1, 1007, ComponentKind::Numbers),
        (128, 24, 2, 0, ComponentKind::Numbers),
    ] {
        for (version, big_endian) in [(1, false), (1, true), (2, false), (2, true)] {
            let mut nifti = Nifti::new(datatype, bits);
            (nifti.version, nifti.big_endian, nifti.intent) = (version, big_endian, intent);
            nifti.dim = [5, 3, 2, 1, 1, components, 0, 0];
            let bytes = nifti.with(&vec![0; 6 * bits as usize / 8 * components as usize]);
            let found = header_of("a.nii", &bytes).meaning;
            assert_eq!(found, wanted, "{datatype} {intent} version {version}");
        }
    }
}

#[test]
fn nifti_says_by_intent_that_values_are_labels() {
    for (intent, components, wanted) in [(1002, 1, true), (0, 1, false), (1002, 2, false)] {
        let mut nifti = Nifti::new(2, 8);
        nifti.intent = intent;
        nifti.dim = [5, 3, 2, 1, 1, components, 0, 0];
        let bytes = nifti.with(&vec![0; 6 * components as usize]);
        assert_eq!(header_of("a.nii", &bytes).is_labels, wanted, "{intent}");
    }
}

#[test]
fn nrrd_says_it_by_kinds() {
    for (kind, components, wanted) in [
        ("RGB-color", 3, ComponentKind::Rgb),
        ("3-color", 3, ComponentKind::Rgb),
        ("RGBA-color", 4, ComponentKind::Rgba),
        ("vector", 2, ComponentKind::Vector),
        ("3-gradient", 3, ComponentKind::Vector),
        ("covariant-vector", 3, ComponentKind::Vector),
        ("HSV-color", 3, ComponentKind::Numbers),
        ("list", 3, ComponentKind::Numbers),
        ("RGB-color", 4, ComponentKind::Numbers),
    ] {
        let text = format!(
            "NRRD0004\ntype: uchar\ndimension: 4\nsizes: {components} 3 2 1\nkinds: {kind} domain domain domain\n\
             encoding: raw\n\n"
        );
        let mut bytes = text.into_bytes();
        bytes.extend(vec![0; 6 * components]);
        assert_eq!(header_of("a.nrrd", &bytes).meaning, wanted, "{kind}");
    }
}

#[test]
fn metaimage_is_taken_at_its_writers_habits_and_that_is_said() {
    for (channels, name, bytes_each, wanted) in [
        (3, "MET_UCHAR", 1, ComponentKind::Rgb),
        (4, "MET_UCHAR", 1, ComponentKind::Rgba),
        (3, "MET_FLOAT", 4, ComponentKind::Vector),
        (2, "MET_FLOAT", 4, ComponentKind::Numbers),
        (3, "MET_SHORT", 2, ComponentKind::Numbers),
        (2, "MET_UCHAR", 1, ComponentKind::Numbers),
    ] {
        let text = format!(
            "ObjectType = Image\nNDims = 3\nDimSize = 3 2 2\nElementSpacing = 1 1 1\n\
             ElementNumberOfChannels = {channels}\nElementType = {name}\n\
             BinaryDataByteOrderMSB = False\nElementDataFile = LOCAL\n"
        );
        let mut bytes = text.into_bytes();
        bytes.extend(vec![0; 12 * channels * bytes_each]);
        let header = header_of("a.mha", &bytes);
        assert_eq!(header.meaning, wanted, "{channels} {name}");
        let is_said = header
            .notes
            .iter()
            .any(|note| note.contains("are taken as"));
        assert_eq!(
            is_said,
            wanted != ComponentKind::Numbers,
            "{:?}",
            header.notes
        );
    }
}

/// What pictures are taken with decides how they are coloured, and only some formats can say it.
#[cfg(all(feature = "dicom", feature = "tiff", feature = "zarr"))]
#[test]
fn dicom_says_the_modality_and_files_of_microscopes_are_of_microscopes() {
    let fixture = |name: &str| {
        PathBuf::from(env!("CARGO_MANIFEST_DIR"))
            .join("tests/fixtures")
            .join(name)
    };
    let opened = |path: &std::path::Path| {
        let source = open(path, &VolumeSelection::default(), &Limits::default());
        source.unwrap_or_else(|error| panic!("{path:?}: {error}"))
    };
    for (name, wanted) in [
        ("dicom/enhanced_ct.dcm", Some("CT")),
        ("tiff/slices/s0.tif", Some("GM")),
        ("npy/i2-le.npy", None),
    ] {
        let source = opened(&fixture(name));
        assert_eq!(source.header().modality.as_deref(), wanted, "{name}");
    }
    for name in ["ngff-0.4", "ngff-0.5"] {
        let source = crate::zarr::Store::of(name).open().expect("a store");
        assert_eq!(source.header().modality.as_deref(), Some("GM"), "{name}");
    }
}
