//! What the numbers of DICOM slices mean: rescale, unit, padding, and which end is bright.
#![cfg(feature = "dicom")]

use crate::dicom;

use dicom::{Dicom, is_noted, open, read, series, slice_numbers};
use stratavox::volume::VoxelType;

#[test]
fn values_keep_their_numbers_their_unit_and_their_holes() {
    let rescaled = |slice: &mut Dicom, slope: &str, intercept: &str| {
        slice
            .text(0x0028_1053, b"DS", slope)
            .text(0x0028_1052, b"DS", intercept);
    };
    let header = |change: &dyn Fn(usize, &mut Dicom)| {
        let folder = series(3, change);
        let source = open(&folder).unwrap();
        (source.header().clone(), read(source.as_ref(), 0))
    };
    let plain: Vec<f32> = (0..3).flat_map(slice_numbers).collect();
    let (ct, voxels) = header(&|_, slice| {
        rescaled(slice, "2", "-1024");
        slice.text(0x0008_0060, b"CS", "CT");
    });
    assert_eq!(
        (ct.rescale.slope, ct.rescale.intercept, ct.hounsfield),
        (2.0, -1024.0, true)
    );
    assert_eq!((ct.unit.as_deref(), voxels), (Some("HU"), plain.clone()));
    let (unspecified, _) = header(&|_, slice| {
        rescaled(slice, "1", "0");
        slice
            .text(0x0008_0060, b"CS", "CT")
            .text(0x0028_1054, b"LO", "US");
    });
    assert_eq!((unspecified.hounsfield, unspecified.unit), (false, None));

    let (pet, voxels) = header(&|k, slice| {
        rescaled(slice, ["0.1", "0.25", "3"][k], "0");
        slice
            .text(0x0008_0060, b"CS", "PT")
            .text(0x0054_1001, b"CS", "BQML");
    });
    assert_eq!(
        (pet.stored, pet.rescale.slope, pet.unit.as_deref()),
        (VoxelType::F32, 1.0, Some("BQML"))
    );
    assert!(is_noted(&pet, "rescale of its own"), "{:?}", pet.notes);
    let slopes = [0.1, 0.25, 3.0];
    let wanted: Vec<f32> = plain
        .iter()
        .enumerate()
        .map(|(i, n)| (f64::from(*n) * slopes[i / 24]) as f32)
        .collect();
    assert_eq!(voxels, wanted);

    let (inverted, voxels) = header(&|_, slice| {
        slice
            .text(0x0028_0004, b"CS", "MONOCHROME1")
            .u16(0x0028_0101, 12)
            .u16(0x0028_0102, 11);
    });
    let low = voxels.iter().copied().fold(f32::INFINITY, f32::min);
    assert_eq!(
        (inverted.rescale.slope, inverted.rescale.intercept),
        (-1.0, -1.0)
    );
    assert!(
        low >= -2048.0 && is_noted(&inverted, "MONOCHROME1"),
        "{low}"
    );
    let (measured, _) = header(&|_, slice| {
        rescaled(slice, "1", "0");
        slice
            .text(0x0028_0004, b"CS", "MONOCHROME1")
            .text(0x0028_1054, b"LO", "HU")
            .text(0x0008_0060, b"CS", "CT");
    });
    assert_eq!(
        measured.rescale.slope, 1.0,
        "what is measured is not turned round"
    );

    let (padded, voxels) = header(&|_, slice| {
        slice.put(0x0028_0120, b"SS", (-500_i16).to_le_bytes().to_vec());
        slice.put(0x0028_0121, b"SS", (-497_i16).to_le_bytes().to_vec());
    });
    assert_eq!(padded.fill, Some(-500.0));
    assert_eq!(
        voxels[..6],
        [-500.0, -500.0, -500.0, -500.0, -496.0, -495.0]
    );
}
