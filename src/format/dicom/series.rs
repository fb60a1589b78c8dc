//! A folder to series: every file looked at once, no pixel read.

use super::DICOM;
use super::fields::DataSet;
use super::file::{Found, PictureFile, recognizes, recognizes_bare, scan};
use super::picture::{Picture, pictures};
use super::quantity::Quantity;
use super::tags::{self, *};
use crate::format::convert::to_u64;
use crate::format::place;
use crate::format::problem::{at, escape, invalid, io, unsupported};
use crate::volume::{Limits, Problem, ReadError, Series};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Folders in folders, as a disk from a hospital has them.
const DEEPEST: u32 = 8;
/// As many first bytes as tell DICOM from other files.
const FIRST_BYTES: u64 = 132;

/// The pictures of one series.
#[derive(Debug, Default)]
pub(super) struct Group {
    pub uid: String,
    pub description: String,
    pub files: Vec<PictureFile>,
    pub pictures: Vec<Picture>,
    pub quantity: Option<Quantity>,
    /// The first of its files that we do not read.
    pub refused: Option<ReadError>,
    refused_files: usize,
}

impl Group {
    pub(super) fn series(&self) -> Series {
        Series {
            uid: escape(&self.uid),
            description: escape(&self.description),
            pictures: self.pictures.len().saturating_add(self.refused_files),
        }
    }

    /// Adds a picture or several; what is wrong with them is kept until the series is wanted.
    fn add(&mut self, file: PictureFile, set: &DataSet, limits: &Limits) {
        let path = file.path.clone();
        let added = self.try_add(file, set, limits);
        if let Err(problem) = added {
            self.refuse(at(&path)(problem));
        }
    }

    fn try_add(
        &mut self,
        file: PictureFile,
        set: &DataSet,
        limits: &Limits,
    ) -> Result<(), Problem> {
        // Frames are believed as far as there are bytes: the pixels themselves are compared later.
        let most = file
            .place
            .bytes
            .unwrap_or(file.length / 8)
            .saturating_mul(8);
        let frames = file.layout.frames;
        let count = self
            .pictures
            .len()
            .saturating_add(usize::try_from(frames).unwrap_or(usize::MAX));
        if u64::from(frames) > most || count > limits.max_files {
            let wanted = format!("at most {} frames", most.min(to_u64(limits.max_files)));
            return Err(invalid(
                DICOM,
                &tags::name(NUMBER_OF_FRAMES),
                wanted,
                &count.to_string(),
            ));
        }
        let quantity = Quantity::of(set, &file.layout)?;
        let first = self.quantity.get_or_insert_with(|| quantity.clone());
        if *first != quantity {
            let wanted = format!(
                "{} as in the other pictures of the series",
                first.unit.as_deref().unwrap_or("none")
            );
            let found = quantity.unit.unwrap_or_default();
            return Err(invalid(DICOM, &tags::name(RESCALE_TYPE), wanted, &found));
        }
        let mut added = pictures(set, self.files.len(), frames)?;
        for picture in &mut added {
            picture.rescale = quantity.turned(picture.rescale, &file.layout);
        }
        self.pictures.append(&mut added);
        self.files.push(file);
        Ok(())
    }

    fn refuse(&mut self, error: ReadError) {
        self.refused_files = self.refused_files.saturating_add(1);
        self.refused.get_or_insert(error);
    }
}

/// What a folder holds.
#[derive(Debug, Default)]
pub(super) struct Contents {
    /// By UID.
    pub groups: Vec<Group>,
    /// DICOM without pictures.
    pub without_pictures: usize,
    /// Files of other kinds.
    pub not_dicom: usize,
}

/// True where a folder holds a DICOM file.
pub(in crate::format) fn is_folder_of_pictures(folder: &Path, limits: &Limits) -> bool {
    let mut files = Vec::new();
    // A folder of too many files, or with links, is opened too: that gives the error.
    files_in(folder, limits, &mut files).is_err() || files.iter().any(|file| is_dicom(file))
}

fn is_dicom(path: &Path) -> bool {
    place::open_regular(path)
        .and_then(|(mut file, _)| place::first_bytes(&mut file, FIRST_BYTES))
        .is_ok_and(|first| recognizes(&first) || recognizes_bare(&first))
}

fn has_dicom_name(path: &Path) -> bool {
    let ending = path
        .extension()
        .and_then(|ending| ending.to_str())
        .unwrap_or("");
    let is_hidden = path
        .file_name()
        .is_some_and(|name| name.as_encoded_bytes().starts_with(b"."));
    !is_hidden && ["dcm", "ima", "dicom"].contains(&ending.to_ascii_lowercase().as_str())
}

/// Looks at all files in a folder, or at the one file that `path` is.
pub(super) fn contents(path: &Path, limits: &Limits) -> Result<Contents, ReadError> {
    let is_folder = path.is_dir();
    let mut files = Vec::new();
    match is_folder {
        true => files_in(path, limits, &mut files)?,
        false => files.push(path.to_owned()),
    }
    files.sort();
    let mut contents = Contents::default();
    let mut groups: BTreeMap<String, Group> = BTreeMap::new();
    for file in files {
        if is_folder && !is_dicom(&file) {
            // A slice that is empty or cut to pieces must not be missed in silence.
            if has_dicom_name(&file) {
                let what = ": its name is that of a DICOM file and its content is not".to_owned();
                return Err(at(&file)(Problem::UnknownFormat(what)));
            }
            contents.not_dicom = contents.not_dicom.saturating_add(1);
            continue;
        }
        let (set, found) = match scan(&file, limits)? {
            Found::Picture(picture, set) => (set, Ok(picture)),
            Found::Refused(error, set) => (set, Err(error)),
            Found::Other => {
                contents.without_pictures = contents.without_pictures.saturating_add(1);
                continue;
            }
        };
        let uid = set.text(SERIES_INSTANCE_UID).unwrap_or_default();
        let group = groups.entry(uid.clone()).or_insert_with(|| Group {
            uid,
            description: set.text(SERIES_DESCRIPTION).unwrap_or_default(),
            ..Group::default()
        });
        match found {
            Ok(picture) => group.add(*picture, &set, limits),
            Err(error) => group.refuse(error),
        }
    }
    contents.groups = groups.into_values().collect();
    // Most pictures first: a scout of two comes after the series that it was made for.
    contents
        .groups
        .sort_by_key(|group| std::cmp::Reverse(group.series().pictures));
    Ok(contents)
}

/// A link may lead out of the folder, as a name in a header may.
fn link() -> Problem {
    unsupported(
        DICOM,
        "a folder with links, where limits are those for untrusted files,",
    )
}

/// All regular files in a folder and the folders in it; the first ones where there are too many. A folder of
/// strangers holds no links.
fn files_in(folder: &Path, limits: &Limits, files: &mut Vec<PathBuf>) -> Result<(), ReadError> {
    let mut folders = vec![(folder.to_owned(), 0_u32)];
    while let Some((folder, depth)) = folders.pop() {
        let listing = || io("listing the folder");
        let entries = std::fs::read_dir(&folder).map_err(|cause| at(&folder)(listing()(cause)))?;
        for entry in entries {
            let entry = entry.map_err(|cause| at(&folder)(listing()(cause)))?;
            let path = entry.path();
            let kind = entry
                .file_type()
                .map_err(|cause| at(&path)(listing()(cause)))?;
            if kind.is_dir() && depth < DEEPEST {
                folders.push((path, depth.saturating_add(1)));
            } else if kind.is_symlink() && !limits.detached {
                return Err(at(&path)(link()));
            } else if kind.is_file() || kind.is_symlink() && path.is_file() {
                files.push(path);
            }
            if files.len().saturating_add(folders.len()) > limits.max_files {
                let wanted = format!("at most {} files", limits.max_files);
                return Err(at(&folder)(invalid(DICOM, "folder", wanted, "more")));
            }
        }
    }
    Ok(())
}
