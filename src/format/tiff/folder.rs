//! A folder of slices, each a TIFF of one page: in the order of the numbers in their names.

use super::TIFF;
use super::single::Single;
use super::source::PageAt;
use super::volume::Parts;
use crate::format::place::{first_bytes, open_regular};
use crate::format::problem::{self, at, invalid, unsupported};
use crate::volume::{Limits, Problem, ReadError, Source, VolumeSelection};
use std::cmp::Ordering;
use std::path::{Path, PathBuf};

/// What stands in a folder.
#[derive(Debug, Default)]
struct Listing {
    /// Files that are called TIFF, in natural order.
    slices: Vec<PathBuf>,
    /// Other files that are not hidden.
    others: usize,
    /// The first of them.
    looked_at: Vec<PathBuf>,
    /// True where a name is a link's, which may lead out of the folder.
    has_links: bool,
    /// True where there is what other readers read: DICOM files, Zarr arrays.
    is_of_others: bool,
}

/// True for a folder of files that are called TIFF, and are; other files may lie beside them, but no DICOM or Zarr.
pub(crate) fn recognizes_folder(path: &Path) -> bool {
    let listing = Listing::read(path, usize::MAX).unwrap_or_default();
    let first = listing.slices.first().and_then(|first| {
        let (mut file, _) = open_regular(first).ok()?;
        first_bytes(&mut file, 8).ok()
    });
    !listing.is_of_others
        && first.is_some_and(|first| super::recognizes(&first))
        && !listing.looked_at.iter().any(|other| is_dicom(other))
}

/// Files of any other name that are looked into: DICOM files often have none of their own.
const MOST_LOOKED_AT: usize = 64;

/// True for a file with the mark of DICOM, PS3.10 7.1: 128 bytes of anything, then four letters.
fn is_dicom(path: &Path) -> bool {
    open_regular(path)
        .and_then(|(mut file, _)| first_bytes(&mut file, 132))
        .is_ok_and(|first| first.ends_with(b"DICM"))
}

/// Opens a folder's slices as one volume.
pub(crate) fn open_folder(
    path: &Path,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    let listing = Listing::read(path, limits.max_files).map_err(at(path))?;
    let (Some(first), Some(last)) = (listing.slices.first(), listing.slices.last()) else {
        return Err(at(path)(invalid(TIFF, "folder", "TIFF files", "none")));
    };
    if listing.has_links && !limits.detached {
        let what = "a folder with links, where limits are those for untrusted files,";
        return Err(at(path)(unsupported(TIFF, what)));
    }
    if listing.slices.len() == 1 {
        return super::open(first, wanted, limits);
    }
    let mut notes = vec![format!(
        "{} files in the order of the numbers in their names, from `{}` to `{}`",
        listing.slices.len(),
        shown(first),
        shown(last)
    )];
    if listing.others > 0 {
        notes.push(format!(
            "{} other files of the folder are not read",
            listing.others
        ));
    }
    let mut pages = Vec::new();
    let mut spacing = None;
    for (index, slice) in listing.slices.iter().enumerate() {
        let mut file = Single::open(slice, limits).map_err(at(slice))?;
        let mut copies = Vec::new();
        file.skip_small_copies(&mut copies).map_err(at(slice))?;
        if file.pages.len() != 1 {
            let wanted = "one page in each file of a folder";
            let found = file.pages.len().to_string();
            return Err(at(slice)(invalid(TIFF, "pages", wanted, &found)));
        }
        if spacing.is_none() {
            spacing = Some(file.spacing().map_err(at(slice))?);
        }
        pages.extend(file.places(index).collect::<Vec<PageAt>>());
    }
    let parts = Parts {
        depth: u32::try_from(pages.len()).unwrap_or(u32::MAX),
        spacing: spacing.unwrap_or_default(),
        notes,
        ..Parts::new(listing.slices.clone(), pages)
    };
    Ok(Box::new(parts.source(path, limits)?))
}

fn shown(path: &Path) -> String {
    let name = path.file_name().map(|name| name.to_string_lossy());
    problem::escape(&name.unwrap_or_default())
}

impl Listing {
    fn read(path: &Path, most: usize) -> Result<Self, Problem> {
        let mut listing = Self::default();
        let entries = std::fs::read_dir(path).map_err(problem::io("listing the folder"))?;
        for entry in entries {
            let entry = entry.map_err(problem::io("listing the folder"))?;
            let name = entry.file_name().to_string_lossy().to_ascii_lowercase();
            if matches!(
                name.as_str(),
                "zarr.json" | ".zarray" | ".zgroup" | ".zattrs" | "dicomdir"
            ) {
                listing.is_of_others = true;
            }
            let path = entry.path();
            if name.starts_with('.') || !path.is_file() {
                continue;
            }
            match path.extension().and_then(|ending| ending.to_str()) {
                Some(ending) if ["tif", "tiff"].contains(&ending.to_ascii_lowercase().as_str()) => {
                    listing.has_links |= path.is_symlink();
                    listing.slices.push(path);
                }
                Some(ending) if ending.eq_ignore_ascii_case("dcm") => listing.is_of_others = true,
                _ => {
                    listing.others = listing.others.saturating_add(1);
                    if listing.looked_at.len() < MOST_LOOKED_AT {
                        listing.looked_at.push(path);
                    }
                }
            }
            if listing.slices.len() > most {
                let wanted = format!("at most {most} files");
                return Err(invalid(TIFF, "folder", wanted, "more"));
            }
        }
        listing
            .slices
            .sort_by(|a, b| natural(&name_of(a), &name_of(b)));
        Ok(listing)
    }
}

fn name_of(path: &Path) -> String {
    let name = path.file_name().map(|name| name.to_string_lossy());
    name.unwrap_or_default().into_owned()
}

/// Names by their numbers: `s2` before `s10`; where all is equal, by their characters.
fn natural(a: &str, b: &str) -> Ordering {
    let (mut left, mut right) = (a, b);
    loop {
        let (Some(l), Some(r)) = (left.chars().next(), right.chars().next()) else {
            return left.len().cmp(&right.len()).then_with(|| a.cmp(b));
        };
        let order = if l.is_ascii_digit() && r.is_ascii_digit() {
            let (number, rest) = digits(left);
            let (other, other_rest) = digits(right);
            (left, right) = (rest, other_rest);
            number
                .len()
                .cmp(&other.len())
                .then_with(|| number.cmp(other))
        } else {
            (left, right) = (
                left.get(l.len_utf8()..).unwrap_or(""),
                right.get(r.len_utf8()..).unwrap_or(""),
            );
            l.cmp(&r)
        };
        if order != Ordering::Equal {
            return order;
        }
    }
}

/// The number at the beginning without its leading zeros, of any length, and what follows.
fn digits(text: &str) -> (&str, &str) {
    let end = text.find(|c: char| !c.is_ascii_digit());
    let (number, rest) = text
        .split_at_checked(end.unwrap_or(text.len()))
        .unwrap_or((text, ""));
    (number.trim_start_matches('0'), rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_come_in_the_order_of_their_numbers() {
        let mut names = [
            "s10.tif",
            "s9.tif",
            "s009b.tif",
            "s1.tif",
            "r99.tif",
            "s.tif",
            "s01.tif",
        ];
        names.sort_by(|a, b| natural(a, b));
        assert_eq!(
            names,
            [
                "r99.tif",
                "s.tif",
                "s01.tif",
                "s1.tif",
                "s9.tif",
                "s009b.tif",
                "s10.tif"
            ]
        );
    }
}
