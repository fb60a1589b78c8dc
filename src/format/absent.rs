//! Readers that a build leaves out: their files are known by their first bytes, and refused by the feature's name.

#![allow(unused, reason = "each build leaves out others")]

macro_rules! absent {
    ($($format:ident, $feature:literal, $recognizes:expr;)*) => {$(
        pub(super) mod $format {
            use crate::format::problem::{at, unsupported};
            use crate::volume::{Limits, ReadError, Source, VolumeSelection};
            use std::path::Path;

            pub(in crate::format) fn recognizes(first: &[u8]) -> bool {
                let recognizes: fn(&[u8]) -> bool = $recognizes;
                recognizes(first)
            }

            pub(in crate::format) fn open(
                path: &Path,
                _: &VolumeSelection,
                _: &Limits,
            ) -> Result<Box<dyn Source>, ReadError> {
                let what = concat!("a file in a build without the feature `", $feature, "`");
                Err(at(path)(unsupported(stringify!($format), what)))
            }
        }
    )*};
}

absent! {
    dicom, "dicom", |first| first.get(128..132) == Some(b"DICM");
    hdf5, "netcdf", |first| first.starts_with(b"\x89HDF");
    netcdf, "netcdf", |first| first.starts_with(b"CDF");
    tiff, "tiff", |first| [b"II\x2a\0", b"MM\0\x2a", b"II\x2b\0", b"MM\0\x2b"].iter().any(|head| first.starts_with(*head));
}
