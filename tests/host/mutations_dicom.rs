//! Mutated DICOM files, by the harness of `mutations.rs`.

use crate::survive::survive;

/// Files of many frames that pydicom wrote, in each transfer syntax.
#[test]
fn dicom_survives_mutations() {
    macro_rules! fixture {
        ($name:literal) => {
            vec![(
                concat!($name, ".x"),
                include_bytes!(concat!("../fixtures/dicom/", $name, ".dcm")).to_vec(),
            )]
        };
    }
    survive(
        "dicom",
        &[
            fixture!("implicit_i16"),
            fixture!("big_i16"),
            fixture!("deflated_i16"),
            fixture!("rle_fragments"),
            fixture!("jpeg_rgb_422"),
            fixture!("jpeg_lossless_i16"),
            fixture!("j2k_i16"),
            fixture!("j2k_lossy_rgb"),
            fixture!("enhanced_slopes"),
            fixture!("segmentation"),
        ],
    );
}

#[test]
fn dicom_folders_survive_mutations() {
    let slice = |k: usize| crate::dicom::Dicom::slice(k, [1.0, 2.0, 1.5 * k as f64]).bytes();
    survive(
        "dicom-folder",
        &[vec![
            ("slice0.dcm", slice(0)),
            ("slice1.dcm", slice(1)),
            ("slice2.dcm", slice(2)),
        ]],
    );
}
