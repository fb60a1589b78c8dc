//! Which file holds the voxels: the header's own, or `.img` beside `.hdr`, each compressed or not.

use super::NIFTI;
use crate::format::problem::{at, missing};
use crate::volume::ReadError;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// The header that belongs to `path`: itself, or the `.hdr` beside an `.img`.
pub(super) fn header_of(path: &Path) -> Result<PathBuf, ReadError> {
    if role(path) != Some("img") {
        return Ok(path.to_owned());
    }
    partner(path, "hdr").ok_or_else(|| at(path)(missing(NIFTI, "`.hdr` file beside it")))
}

/// The `.img` that belongs to a header.
pub(super) fn image_of(header: &Path) -> Result<PathBuf, ReadError> {
    partner(header, "img").ok_or_else(|| at(header)(missing(NIFTI, "`.img` file beside it")))
}

/// True for a name that ends in `.gz`.
pub(super) fn is_compressed(path: &Path) -> bool {
    path.extension()
        .and_then(OsStr::to_str)
        .is_some_and(|extension| extension.eq_ignore_ascii_case("gz"))
}

/// `img` or `hdr`, whatever the case, with `.gz` behind or not.
fn role(path: &Path) -> Option<&'static str> {
    let (_, extension, _) = parts(path)?;
    ["img", "hdr"]
        .into_iter()
        .find(|role| extension.eq_ignore_ascii_case(role))
}

/// The file of the same name with another extension, as compressed as this one if there is a choice.
fn partner(path: &Path, extension: &str) -> Option<PathBuf> {
    let (stem, own, is_compressed) = parts(path)?;
    let extension = match own.chars().all(char::is_uppercase) {
        true => extension.to_uppercase(),
        false => extension.to_owned(),
    };
    let plain = stem.with_added_extension(&extension);
    let compressed = plain.with_added_extension("gz");
    let [first, second] = match is_compressed {
        true => [compressed, plain],
        false => [plain, compressed],
    };
    [first, second].into_iter().find(|path| path.is_file())
}

/// `a/b`, `img` and true of `a/b.img.gz`.
fn parts(path: &Path) -> Option<(PathBuf, String, bool)> {
    let is_compressed = is_compressed(path);
    let path = match is_compressed {
        true => path.with_extension(""),
        false => path.to_owned(),
    };
    let extension = path.extension()?.to_str()?.to_owned();
    Some((path.with_extension(""), extension, is_compressed))
}
