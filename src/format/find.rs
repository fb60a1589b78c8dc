//! Which volumes lie in a folder.
//!
//! ```text
//! folder of DICOM pictures, of TIFF slices, Zarr     one volume: the folder
//! NAME.img beside NAME.hdr; what a .mhd or .nhdr     no volume: data of the one beside it
//!     in the folder names
//! a file that a reader knows, by content or name     a volume
//! anything else                                      left alone
//! ```

use super::problem::{self, at};
#[cfg(feature = "zarr")]
use super::zarr;
use super::{FOLDERS, READERS, Reader, first_bytes, raw};
use crate::volume::{Limits, ReadError, VolumeSelection};
use std::path::{Path, PathBuf};

/// How to look.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Search {
    /// In folders inside folders too.
    pub recursive: bool,
    /// Files that end in `.raw` are volumes, whose layout the caller knows.
    pub with_raw: bool,
}

/// What a folder holds.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Found {
    /// Files and folders that are volumes, in the order of their names.
    pub volumes: Vec<PathBuf>,
    /// Files that are none and folders that were not looked into, hidden ones left out.
    pub left_alone: usize,
}

/// Folders inside folders that are looked into.
const DEEPEST: u32 = 32;

/// The volumes in `folder`, or the folder itself where it is one.
///
/// A file that is called like a volume and cannot be read is among them: who opens it learns what is wrong.
///
/// # Errors
/// The folder cannot be listed.
pub fn find(folder: &Path, search: Search, limits: &Limits) -> Result<Found, ReadError> {
    find_below(folder, search, limits, 0)
}

/// The name of a volume's file without the ending that says what kind of file it is.
pub fn stem(path: &Path) -> &str {
    let name = path.file_name().and_then(|name| name.to_str());
    let name = name.unwrap_or_default();
    let lower = name.to_ascii_lowercase();
    let endings = READERS.iter().flat_map(|reader| reader.endings);
    let endings = endings.chain(&["raw", "zarr"]);
    let ends = endings.filter(|ending| {
        lower
            .strip_suffix(**ending)
            .is_some_and(|s| s.ends_with('.'))
    });
    let longest = ends.map(|ending| ending.len().saturating_add(1)).max();
    let end = name.len().saturating_sub(longest.unwrap_or(0));
    name.get(..end)
        .filter(|stem| !stem.is_empty())
        .unwrap_or(name)
}

/// What a file is, as far as its first bytes and its name say.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Dicom,
    Tiff,
    Other,
}

fn find_below(
    folder: &Path,
    search: Search,
    limits: &Limits,
    depth: u32,
) -> Result<Found, ReadError> {
    if is_zarr(folder) {
        return Ok(Found {
            volumes: vec![folder.to_owned()],
            left_alone: 0,
        });
    }
    let (files, folders) = listed(folder)?;
    let named = names_in_headers(&files);
    let mut found = Found::default();
    let mut kinds = Vec::new();
    for file in &files {
        match kind_of(file, search).filter(|_| !is_data(file, &files, &named)) {
            Some(kind) => kinds.push((kind, file)),
            None => found.left_alone = found.left_alone.saturating_add(1),
        }
    }
    let count = |wanted| kinds.iter().filter(|(kind, _)| *kind == wanted).count();
    let (dicom, tiff) = (count(Kind::Dicom), count(Kind::Tiff));
    // Slices of one stack, where there is nothing else that they could be.
    let is_stack = tiff > 1 && tiff == kinds.len() && opens(folder, limits);
    if dicom > 0 || is_stack {
        found.volumes.push(folder.to_owned());
    }
    let alone = kinds.into_iter().filter(|(kind, _)| match kind {
        Kind::Dicom => false,
        Kind::Tiff => !is_stack,
        Kind::Other => true,
    });
    found.volumes.extend(alone.map(|(_, file)| file.clone()));
    for inner in folders {
        let is_link = inner.symlink_metadata().is_ok_and(|data| data.is_symlink());
        // A link could lead in a circle.
        let goes_in = search.recursive && depth < DEEPEST && !is_link;
        let below = match goes_in {
            true => find_below(&inner, search, limits, depth.saturating_add(1))?,
            false => Found::default(),
        };
        if goes_in {
            found.volumes.extend(below.volumes);
            found.left_alone = found.left_alone.saturating_add(below.left_alone);
        } else if is_one(&inner, limits) {
            found.volumes.push(inner);
        } else {
            found.left_alone = found.left_alone.saturating_add(1);
        }
    }
    found.volumes.sort();
    Ok(found)
}

/// True for a folder that is a volume by itself.
fn is_one(folder: &Path, limits: &Limits) -> bool {
    let search = Search::default();
    if is_zarr(folder) {
        return true;
    }
    let Ok((files, _)) = listed(folder) else {
        return false;
    };
    let mut kinds = files.iter().filter_map(|file| kind_of(file, search));
    let Some(first) = kinds.next() else {
        return false;
    };
    let is_of_one_kind = first != Kind::Other && kinds.all(|kind| kind == first);
    is_of_one_kind && (first == Kind::Dicom || files.len() > 1 && opens(folder, limits))
}

/// Files and folders that are not hidden, each in the order of their names.
fn listed(folder: &Path) -> Result<(Vec<PathBuf>, Vec<PathBuf>), ReadError> {
    let failed = |cause| at(folder)(problem::io("listing the folder")(cause));
    let (mut files, mut folders) = (Vec::new(), Vec::new());
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let is_hidden = path
            .file_name()
            .is_some_and(|name| name.as_encoded_bytes().starts_with(b"."));
        if is_hidden {
        } else if path.is_dir() {
            folders.push(path);
        } else if path.is_file() {
            files.push(path);
        }
    }
    files.sort();
    folders.sort();
    Ok((files, folders))
}

fn kind_of(file: &Path, search: Search) -> Option<Kind> {
    let first = first_bytes(file).unwrap_or_default();
    let by_content = READERS.iter().find(|reader| (reader.recognizes)(&first));
    let reader = by_content.or_else(|| Reader::of_name(file));
    match reader {
        // By the first of its endings: readers that this build lacks keep their place.
        Some(reader) => Some(match reader.endings.first() {
            None | Some(&"dcm") => Kind::Dicom,
            Some(&"tif") => Kind::Tiff,
            Some(_) => Kind::Other,
        }),
        None => {
            let is_raw = file
                .extension()
                .is_some_and(|it| it.eq_ignore_ascii_case("raw"));
            let is_known = search.with_raw || raw::sidecar_of(file).is_some();
            (is_raw && is_known).then_some(Kind::Other)
        }
    }
}

/// True for voxels that a header beside them speaks of.
fn is_data(file: &Path, files: &[PathBuf], named: &str) -> bool {
    let Some(name) = file.file_name().and_then(|name| name.to_str()) else {
        return false;
    };
    let lower = name.to_ascii_lowercase();
    let stem = lower
        .strip_suffix(".img")
        .or_else(|| lower.strip_suffix(".img.gz"));
    let has_header = stem.is_some_and(|stem| {
        files.iter().any(|other| {
            let other = other.file_name().and_then(|name| name.to_str());
            let other = other.unwrap_or_default().to_ascii_lowercase();
            other
                .strip_prefix(stem)
                .is_some_and(|end| [".hdr", ".hdr.gz"].contains(&end))
        })
    });
    let is_word = |line: &str| {
        let before = line.strip_suffix(name);
        before
            .is_some_and(|before| before.ends_with([' ', '\t', '=', ':', '/']) || before.is_empty())
    };
    has_header || named.lines().any(|line| is_word(line.trim_end()))
}

/// The lines of headers that lie apart from their voxels.
fn names_in_headers(files: &[PathBuf]) -> String {
    let ends = |file: &&PathBuf| {
        let ending = file.extension().and_then(|ending| ending.to_str());
        let ending = ending.unwrap_or_default().to_ascii_lowercase();
        ["mhd", "nhdr"].contains(&ending.as_str())
    };
    let mut text = String::new();
    for file in files.iter().filter(ends) {
        let first = first_bytes(file).unwrap_or_default();
        text.push_str(&String::from_utf8_lossy(&first));
        text.push('\n');
    }
    text
}

fn opens(folder: &Path, limits: &Limits) -> bool {
    let reader = FOLDERS
        .iter()
        .find(|reader| (reader.recognizes)(folder, limits));
    reader.is_some_and(|reader| (reader.open)(folder, &VolumeSelection::default(), limits).is_ok())
}

#[cfg(feature = "zarr")]
fn is_zarr(folder: &Path) -> bool {
    zarr::recognizes(folder)
}

#[cfg(not(feature = "zarr"))]
fn is_zarr(_: &Path) -> bool {
    false
}
