//! The folder of a Zarr store: keys to files, none of which lies outside of it.

use super::ZARR;
use crate::format::place::open_regular;
use crate::format::problem::{self, at, escape, invalid};
use crate::volume::{Limits, Problem, ReadError};
use std::fs::File;
use std::io::{ErrorKind, Read, Seek, SeekFrom};
use std::path::{Component, Path, PathBuf};

/// A folder of files that are named by keys with `/` between their parts.
#[derive(Debug)]
pub(super) struct Store {
    /// As the caller wrote it: for messages.
    given: PathBuf,
    /// With every link followed: what a key may not leave.
    real: PathBuf,
}

/// One file of a store, open.
pub(super) struct Value {
    pub path: PathBuf,
    pub bytes: u64,
    file: File,
}

impl Store {
    pub(super) fn open(path: &Path) -> Result<Self, ReadError> {
        let real = path
            .canonicalize()
            .map_err(problem::io("looking for the folder"))
            .map_err(at(path))?;
        Ok(Self {
            given: path.to_owned(),
            real,
        })
    }

    /// The folder as the caller wrote it.
    pub(super) fn path(&self) -> &Path {
        &self.given
    }

    /// Where the file of a key is, for messages.
    pub(super) fn shown(&self, key: &str) -> PathBuf {
        match key {
            "" => self.given.clone(),
            _ => self.given.join(escape(key)),
        }
    }

    /// The file of a key; `None` where there is none. Absolute keys, `..` and links out of the folder are refused.
    pub(super) fn find(&self, key: &str) -> Result<Option<Value>, ReadError> {
        let shown = self.shown(key);
        let wanted = "the name of a file in the Zarr folder";
        let inside = !key.is_empty()
            && !key.contains('\0')
            && Path::new(key)
                .components()
                .all(|part| matches!(part, Component::Normal(_)));
        if !inside {
            return Err(at(&self.given)(invalid(ZARR, "key", wanted, key)));
        }
        let path = self.given.join(key);
        let real = match path.canonicalize() {
            Ok(real) => real,
            // A link to nothing is no missing chunk.
            Err(cause)
                if matches!(cause.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory)
                    && path.symlink_metadata().is_err() =>
            {
                return Ok(None);
            }
            Err(cause) => return Err(at(&shown)(problem::io("looking for the file")(cause))),
        };
        if !real.starts_with(&self.real) {
            let wanted = "a file in the Zarr folder, not a link out of it";
            return Err(at(&shown)(invalid(ZARR, "key", wanted, key)));
        }
        let (file, metadata) = open_regular(&path).map_err(at(&shown))?;
        Ok(Some(Value {
            path: shown,
            bytes: metadata.len(),
            file,
        }))
    }

    /// All of a text file, if it is there and within the limit.
    pub(super) fn text(&self, key: &str, limits: &Limits) -> Result<Option<Vec<u8>>, ReadError> {
        let Some(mut value) = self.find(key)? else {
            return Ok(None);
        };
        let limit_bytes = u64::try_from(limits.max_header_bytes).unwrap_or(u64::MAX);
        if value.bytes > limit_bytes {
            return Err(at(&value.path)(Problem::Limit {
                what: "the header".to_owned(),
                wanted_bytes: value.bytes,
                limit_bytes,
            }));
        }
        let length = value.bytes;
        value.read(0, length).map(Some)
    }

    /// Names of the folders in the folder `key` that are no links, at most `most` of them.
    pub(super) fn folders(&self, key: &str, most: usize) -> Vec<String> {
        let folder = match key {
            "" => self.given.clone(),
            _ => self.given.join(key),
        };
        let Ok(entries) = std::fs::read_dir(folder) else {
            return Vec::new();
        };
        let mut names: Vec<String> = entries
            .filter_map(Result::ok)
            .filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_dir()))
            .filter_map(|entry| entry.file_name().into_string().ok())
            .take(most)
            .collect();
        names.sort();
        names
    }
}

impl Value {
    /// `count` bytes from `start` on; they are there, or it is an error.
    pub(super) fn read(&mut self, start: u64, count: u64) -> Result<Vec<u8>, ReadError> {
        let reading = "reading the file";
        let mut bytes = Vec::new();
        let fits = start
            .checked_add(count)
            .is_some_and(|end| end <= self.bytes);
        let room = usize::try_from(count)
            .ok()
            .filter(|_| fits)
            .filter(|&count| bytes.try_reserve_exact(count).is_ok());
        if room.is_none() {
            return Err(at(&self.path)(Problem::Size {
                format: ZARR,
                wanted_bytes: start.saturating_add(count),
                found_bytes: self.bytes,
            }));
        }
        self.file
            .seek(SeekFrom::Start(start))
            .and_then(|_| (&mut self.file).take(count).read_to_end(&mut bytes))
            .map_err(problem::io(reading))
            .map_err(at(&self.path))?;
        let found = u64::try_from(bytes.len()).unwrap_or(u64::MAX);
        if found != count {
            return Err(at(&self.path)(Problem::Size {
                format: ZARR,
                wanted_bytes: count,
                found_bytes: found,
            }));
        }
        Ok(bytes)
    }
}
