//! Files to [`Source`]s: NIfTI, NRRD, MetaImage, DICOM, raw voxels.
//!
//! A header only promises. [`open`] compares its promises with the bytes that are there before anything is
//! allocated, and [`Source::read`] again as it goes; a file that is too short, too long once decompressed or
//! damaged is an error, never a volume. A header may name files in its own folder only.
//!
//! ```text
//! path -> first bytes -> reader of that format -> Header, Data (files, offsets, encoding, axes) -> Source
//! ```

#![forbid(unsafe_code)]
#![cfg_attr(
    not(test),
    deny(
        clippy::arithmetic_side_effects,
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        clippy::cast_sign_loss,
        clippy::expect_used,
        clippy::indexing_slicing,
        clippy::panic,
        clippy::unwrap_used
    )
)]

mod convert;
mod data;
mod decode;
#[cfg(feature = "dicom")]
mod dicom;
mod file_source;
mod geometry;
mod metaimage;
mod nifti;
mod nrrd;
mod place;
mod problem;
pub mod raw;
mod select;
mod sequence;
mod stream;
mod text;
mod textual;

use crate::volume::{Limits, Problem, ReadError, Source, Wanted};
use problem::at;
use std::path::Path;

/// Bytes that a format is recognized by.
const FIRST_BYTES: u64 = 4096;

/// Opens a file of any format that we read, known by its content.
///
/// Of several volumes in it `wanted` takes one; without a word the first is taken, and the header lists them all.
///
/// # Errors
/// The file cannot be read, is of no known format, says something that cannot be, or promises more voxels than
/// there are bytes. The error names the file, the field, what was wanted and what was found.
pub fn open(path: &Path, wanted: &Wanted, limits: &Limits) -> Result<Box<dyn Source>, ReadError> {
    #[cfg(feature = "dicom")]
    if path.is_dir() && dicom::is_folder_of_pictures(path, limits) {
        return dicom::open(path, wanted, limits);
    }
    let first = first_bytes(path).map_err(at(path))?;
    #[cfg(feature = "dicom")]
    if dicom::recognizes(&first) {
        return dicom::open(path, wanted, limits);
    }
    #[cfg(not(feature = "dicom"))]
    let _ = wanted;
    #[cfg(not(feature = "dicom"))]
    if first.get(128..132) == Some(b"DICM") {
        let what = "DICOM in a build without the feature `dicom`";
        return Err(at(path)(problem::unsupported("dicom", what)));
    }
    let extension = path.extension().and_then(|extension| extension.to_str());
    let extension = extension.unwrap_or("").to_ascii_lowercase();
    // The content decides. Where it is no format's, the name does, and that reader says what is wrong.
    if nrrd::recognizes(&first) {
        Ok(Box::new(nrrd::open(path, limits)?))
    } else if metaimage::recognizes(&first) {
        Ok(Box::new(metaimage::open(path, limits)?))
    } else if nifti::recognizes(&first) {
        Ok(Box::new(nifti::open(path, limits)?))
    } else if matches!(extension.as_str(), "nrrd" | "nhdr") {
        Ok(Box::new(nrrd::open(path, limits)?))
    } else if matches!(extension.as_str(), "mha" | "mhd") {
        Ok(Box::new(metaimage::open(path, limits)?))
    } else if matches!(extension.as_str(), "nii" | "hdr" | "img") || is_compressed_nifti(path) {
        Ok(Box::new(nifti::open(path, limits)?))
    } else if let Some(sidecar) = raw::sidecar_of(path) {
        raw::open_sidecar(&sidecar, limits)
    } else {
        #[cfg(feature = "dicom")]
        if dicom::recognizes_bare(&first) {
            return dicom::open(path, wanted, limits);
        }
        Err(at(path)(unknown(&first)))
    }
}

fn is_compressed_nifti(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    let name = name.unwrap_or("").to_ascii_lowercase();
    [".nii.gz", ".hdr.gz", ".img.gz"]
        .iter()
        .any(|end| name.ends_with(end))
}

fn first_bytes(path: &Path) -> Result<Vec<u8>, Problem> {
    let (mut file, metadata) = place::open_regular(path)?;
    if metadata.len() == 0 {
        return Err(Problem::UnknownFormat(": the file is empty".to_owned()));
    }
    place::first_bytes(&mut file, FIRST_BYTES)
}

fn unknown(first: &[u8]) -> Problem {
    let shown: Vec<String> = first
        .iter()
        .take(8)
        .map(|byte| format!("{byte:02x}"))
        .collect();
    Problem::UnknownFormat(format!(
        ": the file begins with the bytes {}; we read nifti, nrrd, metaimage, dicom, and raw voxels that a spec or a sidecar describes",
        shown.join(" ")
    ))
}
