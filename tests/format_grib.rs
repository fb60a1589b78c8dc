//! GRIB files are refused by their edition, with what makes a file of them that is read.
#![cfg(feature = "files")]

#[path = "shared/files.rs"]
mod files;

use files::Folder;

#[test]
fn an_edition_is_refused_by_its_number_and_other_bytes_by_what_they_are() {
    let folder = Folder::new();
    let message = |edition: u8| {
        let bytes = [&b"GRIB\0\0\x34"[..], &[edition], &[0; 44]].concat();
        folder.refused("a.grib2", bytes)
    };
    assert!(
        message(1).contains("edition 1 (a NetCDF file is read:"),
        "{}",
        message(1)
    );
    assert!(
        message(2).contains("edition 2 (a NetCDF file is read:"),
        "{}",
        message(2)
    );
    assert!(
        message(3).contains("`edition`: wanted 1 or 2, found `3`"),
        "{}",
        message(3)
    );
    for bytes in [&b"GRI"[..], b"GRIB\0\0\x34", b"no grib at all"] {
        let message = folder.refused("a.grib", bytes);
        assert!(
            message.contains("`section 0`: wanted the letters GRIB"),
            "{message}"
        );
    }
}
