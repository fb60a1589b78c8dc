//! DICOM files that are cut, lie about themselves or are something else besides: an error, never a wrong volume.

use crate::dicom::Dicom;
use crate::files::{Folder, message};
use std::path::Path;
use stratavox::format;
use stratavox::volume::{Limits, VolumeSelection};

fn fixture(name: &str) -> Vec<u8> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/dicom");
    std::fs::read(folder.join(name)).unwrap()
}

#[test]
fn a_file_cut_at_any_byte_is_refused() {
    let folder = Folder::new();
    let slice = Dicom::slice(1, [0.0, 1.0, 2.0]).bytes();
    let mut cuts = 0;
    for (name, bytes) in [
        ("slice", slice),
        ("deflated", fixture("deflated_i16.dcm")),
        ("implicit", fixture("implicit_i16.dcm")),
        ("rle", fixture("rle_frames.dcm")),
        ("jpeg", fixture("jpeg_baseline.dcm")),
        ("lossless", fixture("jpeg_lossless_i16.dcm")),
        ("j2k", fixture("j2k_i16.dcm")),
        ("enhanced", fixture("enhanced_ct.dcm")),
    ] {
        folder
            .read(name, &bytes)
            .unwrap_or_else(|e| panic!("{name}: {}", message(&e)));
        let step = bytes.len() / 500 + 1;
        for length in (0..bytes.len())
            .step_by(step)
            .chain(bytes.len() - 40..bytes.len())
        {
            // A stream of deflate is padded to an even length with a zero that nobody reads.
            if name == "deflated" && length + 1 == bytes.len() {
                continue;
            }
            let error = folder.refused(name, &bytes[..length]);
            assert!(error.len() < 1200 && error.is_ascii(), "{error}");
            cuts += 1;
        }
    }
    println!("{cuts} cuts");
    assert!(cuts > 3000, "{cuts}");
}

#[test]
fn a_slice_of_a_folder_that_is_cut_is_never_passed_over() {
    let folder = Folder::new();
    for k in 0..3 {
        folder.write(
            &format!("{k}.dcm"),
            Dicom::slice(k, [0.0, 0.0, k as f64]).bytes(),
        );
    }
    let open = || {
        format::open(
            &folder.path(""),
            &VolumeSelection::default(),
            &Limits::default(),
        )
    };
    assert_eq!(open().unwrap().header().dims, [6, 4, 3]);
    let last = Dicom::slice(2, [0.0, 0.0, 2.0]).bytes();
    for length in 0..last.len() {
        folder.write("2.dcm", &last[..length]);
        let header = open().map(|source| source.header().clone());
        assert!(header.is_err(), "cut at {length}: {header:?}");
    }
}

#[test]
fn a_field_that_cannot_be_is_named() {
    let folder = Folder::new();
    let mut tried = 0;
    let texts = [
        "",
        "abc",
        "nan",
        "inf",
        "1e999",
        "-1",
        "0",
        "0\\0",
        "1\\2\\3\\4\\5\\6\\7",
        "1\\0\\0\\1\\0\\0",
    ];
    let is_right = |tag: u32, text: &str| match (tag, text) {
        // Missing geometry is noted.
        (
            0x0020_0032 | 0x0020_0037 | 0x0028_0030 | 0x0028_1053 | 0x0028_1052 | 0x0018_0088
            | 0x0028_0008 | 0x0020_0013,
            "",
        ) => true,
        (0x0028_1052 | 0x0020_0013 | 0x0018_0088, "-1" | "0") | (0x0028_1053, "-1") => true,
        _ => false,
    };
    for (tag, name) in [
        (0x0020_0032, "ImagePositionPatient"),
        (0x0020_0037, "ImageOrientationPatient"),
        (0x0028_0030, "PixelSpacing"),
        (0x0028_1053, "RescaleSlope"),
        (0x0028_1052, "RescaleIntercept"),
        (0x0018_0088, "SpacingBetweenSlices"),
        (0x0028_0008, "NumberOfFrames"),
        (0x0020_0013, "InstanceNumber"),
    ] {
        for text in texts {
            let bytes = Dicom::slice(1, [0.0; 3]).text(tag, b"DS", text).bytes();
            if is_right(tag, text) {
                folder
                    .read("a", &bytes)
                    .unwrap_or_else(|e| panic!("{name} {text}: {}", message(&e)));
            } else {
                let error = folder.refused("a", &bytes);
                assert!(error.contains(name), "{text}: {error}");
            }
            tried += 1;
        }
    }
    for (tag, name) in [
        (0x0028_0002, "SamplesPerPixel"),
        (0x0028_0010, "Rows"),
        (0x0028_0011, "Columns"),
        (0x0028_0100, "bits allocated"),
        (0x0028_0101, "BitsStored"),
        (0x0028_0102, "BitsStored"),
    ] {
        for number in [0, 2, 3, 17, 64, 255, 256, 65535] {
            let bytes = Dicom::slice(1, [0.0; 3]).u16(tag, number).bytes();
            let is_smaller = matches!(
                (tag, number),
                (0x0028_0010 | 0x0028_0011, 2 | 3) | (0x0028_0101, 2 | 3)
            );
            if is_smaller {
                folder.read("a", &bytes).unwrap();
                continue;
            }
            let error = folder.refused("a", &bytes);
            assert!(
                error.contains(name) || error.contains("promises"),
                "{number}: {error}"
            );
            tried += 1;
        }
        let error = folder.refused(
            "a",
            Dicom::slice(1, [0.0; 3])
                .put(tag, b"US", vec![1, 2, 3])
                .bytes(),
        );
        assert!(error.contains("wanted 2 bytes"), "{error}");
    }
    for tag in Dicom::slice(1, [0.0; 3]).tags() {
        // Whatever is left out: an error or a volume, and no panic.
        let outcome = folder.read("a", Dicom::slice(1, [0.0; 3]).without(tag).bytes());
        let must_be = [0x0028_0010, 0x0028_0011, 0x0028_0100, 0x7fe0_0010];
        assert_eq!(outcome.is_err(), must_be.contains(&tag), "{tag:08x}");
        tried += 1;
    }
    println!("{tried} fields");
}

#[test]
fn a_length_that_lies_takes_no_memory() {
    let folder = Folder::new();
    let slice = Dicom::slice(1, [0.0; 3]).bytes();
    let at = slice
        .windows(4)
        .position(|w| w == [0xe0, 0x7f, 0x10, 0])
        .unwrap()
        + 8;
    for length in [0_u32, 47, 49, 1 << 16, 1 << 31, u32::MAX - 1, u32::MAX] {
        let mut lie = slice.clone();
        lie[at..at + 4].copy_from_slice(&length.to_le_bytes());
        crate::memory::start();
        folder.refused("a", &lie);
        assert!(
            crate::memory::peak_since_start() < 1 << 20,
            "{length}: {}",
            crate::memory::peak_since_start()
        );
    }
    for frames in ["2", "65535", "1000000000", "2147483647"] {
        let lie = Dicom::slice(1, [0.0; 3])
            .text(0x0028_0008, b"IS", frames)
            .bytes();
        crate::memory::start();
        folder.refused("a", &lie);
        assert!(
            crate::memory::peak_since_start() < 1 << 20,
            "{frames}: {}",
            crate::memory::peak_since_start()
        );
    }
    // Sequences in sequences in sequences.
    let mut deep = vec![];
    for _ in 0..4000 {
        deep.extend([0x18, 0, 0x14, 0x91, b'S', b'Q', 0, 0, 255, 255, 255, 255]);
        deep.extend([0xfe, 0xff, 0, 0xe0, 255, 255, 255, 255]);
    }
    let mut file = Dicom::slice(1, [0.0; 3]).bytes();
    let meta = file.windows(4).position(|w| w == [8, 0, 0x16, 0]).unwrap();
    file.splice(meta..meta, deep);
    let error = folder.refused("a", &file);
    assert!(error.contains("at most 24 deep"), "{error}");
}

#[test]
fn a_folder_of_more_files_than_allowed_is_refused() {
    let folder = Folder::new();
    for k in 0..5 {
        folder.write(
            &format!("{k}.dcm"),
            Dicom::slice(k, [0.0, 0.0, k as f64]).bytes(),
        );
    }
    let limits = Limits {
        max_files: 4,
        ..Limits::default()
    };
    let error = format::open(&folder.path(""), &VolumeSelection::default(), &limits)
        .err()
        .expect("refused");
    assert!(
        message(&error).contains("at most 4 files"),
        "{}",
        message(&error)
    );
    let limits = Limits {
        max_bytes: 5 * 6 * 4 * 2 - 1,
        ..Limits::default()
    };
    let source = format::open(&folder.path(""), &VolumeSelection::default(), &limits).unwrap();
    let error = source
        .read(Default::default(), source.header().whole())
        .unwrap_err();
    assert!(
        message(&error).contains("needs 240 bytes"),
        "{}",
        message(&error)
    );
}

#[test]
fn a_file_that_is_something_else_besides_is_said() {
    let folder = Folder::new();
    let mut both = Dicom::slice(1, [0.0; 3]).bytes();
    both[..4].copy_from_slice(b"II*\0");
    let (header, _) = folder.read("a.dcm", &both).unwrap();
    assert!(
        header
            .notes
            .iter()
            .any(|note| note.contains("begins as a TIFF file")),
        "{:?}",
        header.notes
    );
    // Without the first 132 bytes, as files before 1993 are.
    let slice = Dicom::slice(1, [0.0; 3]).bytes();
    folder.read("bare", &slice[132..]).unwrap();
    let data_set = slice.windows(4).position(|w| w == [8, 0, 0x16, 0]).unwrap();
    folder.read("barer", &slice[data_set..]).unwrap();
}
