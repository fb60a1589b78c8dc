//! Picture files that are broken or lie.

#![cfg(all(feature = "png", feature = "exr"))]

#[allow(dead_code, reason = "each file of tests uses some of it")]
use crate::picture_shared;

use picture_shared::{EIGHT, SIXTEEN, picture, rich};
use stratavox::picture::{PictureProblem, read_image, write_picture};

#[test]
fn other_files_are_refused_with_what_was_found() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x");
    let refused = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        read_image(&path).unwrap_err()
    };
    let npy = |header: &str| {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes
    };
    let shaped = |shape| {
        npy(&format!(
            "{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}"
        ))
    };
    assert!(matches!(
        refused(b"").problem,
        PictureProblem::UnknownFormat { .. }
    ));
    assert!(matches!(
        refused(b"GIF89a").problem,
        PictureProblem::UnknownFormat { .. }
    ));
    let wide = refused(&npy(
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1, 4), }",
    ));
    assert!(
        wide.to_string().contains("wanted '<f4', found '<f8'"),
        "{wide}"
    );
    let huge = refused(&shaped("(4294967295, 4294967295, 4)"));
    assert!(
        matches!(huge.problem, PictureProblem::TooLarge { .. }),
        "{huge}"
    );
    let short = refused(&shaped("(2, 3, 4)"));
    assert!(
        matches!(
            short.problem,
            PictureProblem::Size {
                wanted_bytes: 96,
                found_bytes: 0,
                ..
            }
        ),
        "{short}"
    );
    for shape in [
        "(1, 2, 3)",
        "(4,)",
        "()",
        "(1, -1)",
        "(1, 99999999999999999999)",
        "7",
        "(1, 2",
    ] {
        let error = refused(&shaped(shape));
        assert!(
            matches!(
                error.problem,
                PictureProblem::Invalid { field: "shape", .. }
            ),
            "{error}"
        );
    }
    // 100 000 x 1000 pixels promised by 42 bytes of PNG, or by an EXR of one row.
    let small = folder.path().join("small.png");
    write_picture(&picture(1, vec![[0.0; 4]]), &small, EIGHT).unwrap();
    let mut lie = std::fs::read(&small).unwrap();
    lie[16..24].copy_from_slice(&[0, 1, 0x86, 0xa0, 0, 0, 3, 0xe8]);
    let crc = crc32(&lie[12..29]);
    lie[29..33].copy_from_slice(&crc.to_be_bytes());
    let error = refused(&lie);
    assert!(
        matches!(error.problem, PictureProblem::Size { .. }),
        "{error}"
    );
    let small = folder.path().join("small.exr");
    write_picture(&picture(1, vec![[0.0; 4]]), &small, EIGHT).unwrap();
    let mut lie = std::fs::read(&small).unwrap();
    let at = lie
        .windows(10)
        .position(|word| word == b"dataWindow")
        .unwrap()
        + 21
        + 8;
    lie[at..at + 8].copy_from_slice(&[0x9f, 0x86, 1, 0, 0xe7, 3, 0, 0]);
    let error = refused(&lie);
    assert!(
        matches!(error.problem, PictureProblem::Size { .. }),
        "{error}"
    );
    assert!(matches!(
        read_image(&folder.path().join("none")).unwrap_err().problem,
        PictureProblem::Io(_)
    ));
}

#[test]
fn cut_and_garbled_files_are_errors_or_pictures_of_the_same_size() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x");
    let mut state = 7_u64;
    let mut random = move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize
    };
    for (name, options) in [
        ("a.npy", EIGHT),
        ("a.png", EIGHT),
        ("b.png", SIXTEEN),
        ("a.exr", EIGHT),
    ] {
        let source = folder.path().join(name);
        let mut rich = rich();
        rich.layers.truncate(1);
        write_picture(&rich, &source, options).unwrap();
        let whole = std::fs::read(&source).unwrap();
        let mut refused = 0;
        for length in 0..whole.len() {
            std::fs::write(&path, &whole[..length]).unwrap();
            refused += usize::from(read_image(&path).is_err());
        }
        // PNG: a picture is whole before its last chunk is.
        assert!(
            refused + 16 >= whole.len(),
            "{name}: {refused} of {} cuts",
            whole.len()
        );
        for _ in 0..2000 {
            let mut garbled = whole.clone();
            for _ in 0..=random() % 4 {
                let at = random() % garbled.len();
                garbled[at] = [0, 1, 0x7f, 0x80, 0xff, random() as u8][random() % 6];
            }
            std::fs::write(&path, &garbled).unwrap();
            if let Ok(image) = read_image(&path) {
                assert_eq!(
                    image.pixels.len(),
                    image.width as usize * image.height as usize
                );
            }
        }
    }
}

/// CRC-32 of ISO 3309, as PNG's chunks have it.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| {
            (crc >> 1) ^ (0xedb8_8320 * (crc & 1))
        })
    })
}
