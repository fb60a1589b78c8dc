//! Compiled pipelines kept from run to run in a file of the user's cache folder.
//!
//! ```text
//! "stratavox pipelines 1\n"   22 bytes
//! length of the data          u64, little-endian
//! checksum of the data        u64, little-endian: FNV-1a
//! the driver's data
//! ```
//!
//! Drivers trust their data, so it is checked here: whatever is not whole is as good as absent. Nothing that
//! goes wrong with the file stops a render.

use super::Identity;
use std::{
    ffi::OsString,
    fs,
    io::{self, Read, Write},
    path::{Path, PathBuf},
    time::{SystemTime, UNIX_EPOCH},
};

/// Where compiled pipelines are kept.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum PipelineCache {
    /// Nowhere.
    Off,
    /// The user's cache folder, where the system has one.
    #[default]
    UserFolder,
    /// This folder.
    Folder(PathBuf),
}

const MAGIC: &[u8] = b"stratavox pipelines 1\n";
const HEADER_BYTES: usize = MAGIC.len() + 16;

/// No driver keeps more; a file that claims more is not ours.
const MOST_BYTES: u64 = 256 << 20;

impl PipelineCache {
    /// The file for one device and driver.
    pub(super) fn file(&self, identity: &Identity) -> Option<PathBuf> {
        let folder = match self {
            Self::Off => None,
            Self::UserFolder => user_folder(|name| std::env::var_os(name)),
            Self::Folder(folder) => Some(folder.clone()),
        };
        let name = format!(
            "pipelines-{:08x}-{:08x}-{:08x}-{:032x}.bin",
            identity.vendor_id,
            identity.device_id,
            identity.driver_version,
            u128::from_be_bytes(identity.pipeline_cache_uuid)
        );
        folder.map(|folder| folder.join(name))
    }
}

/// The data in `file`, or nothing.
pub(super) fn load(file: &Path) -> Vec<u8> {
    let mut bytes = Vec::new();
    let read = fs::File::open(file).and_then(|file| file.take(MOST_BYTES).read_to_end(&mut bytes));
    match read {
        Ok(_) => unwrap_data(&bytes).map_or_else(Vec::new, <[u8]>::to_vec),
        Err(_) => Vec::new(),
    }
}

/// Replaces `file` in one step: another process sees the old file or the new one.
pub(super) fn save(file: &Path, data: &[u8]) -> io::Result<()> {
    let folder = file.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder)?;
    let now = SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .map_or(0, |since| since.as_nanos());
    let partial = file.with_extension(format!("{}-{now}.partial", std::process::id()));
    let written = write(&partial, data).and_then(|()| fs::rename(&partial, file));
    if written.is_err() {
        // It may not even exist.
        let _ = fs::remove_file(&partial);
    }
    written
}

fn write(file: &Path, data: &[u8]) -> io::Result<()> {
    let mut file = fs::File::create_new(file)?;
    file.write_all(MAGIC)?;
    file.write_all(&(data.len() as u64).to_le_bytes())?;
    file.write_all(&checksum(data).to_le_bytes())?;
    file.write_all(data)?;
    file.sync_all()
}

fn unwrap_data(bytes: &[u8]) -> Option<&[u8]> {
    let (header, data) = bytes.split_at_checked(HEADER_BYTES)?;
    let number = |at: usize| Some(u64::from_le_bytes(header.get(at..at + 8)?.try_into().ok()?));
    let is_whole = header.starts_with(MAGIC)
        && number(MAGIC.len())? == data.len() as u64
        && number(MAGIC.len() + 8)? == checksum(data);
    is_whole.then_some(data)
}

/// FNV-1a of 64 bits (Fowler, Noll, Vo): finds accidents, not attacks.
fn checksum(data: &[u8]) -> u64 {
    data.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3)
    })
}

/// The XDG base directory specification, and what Apple and Microsoft have instead.
fn user_folder(variable: impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    // The specification says to ignore a path that is not absolute.
    let path = |name| {
        variable(name)
            .map(PathBuf::from)
            .filter(|path| path.is_absolute())
    };
    let folder = if cfg!(windows) {
        path("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        path("HOME").map(|home| home.join("Library/Caches"))
    } else {
        path("XDG_CACHE_HOME").or_else(|| path("HOME").map(|home| home.join(".cache")))
    };
    folder.map(|folder| folder.join("stratavox"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file_of(data: &[u8]) -> Vec<u8> {
        let header = [
            MAGIC,
            &(data.len() as u64).to_le_bytes(),
            &checksum(data).to_le_bytes(),
        ];
        [header.concat().as_slice(), data].concat()
    }

    #[test]
    fn every_single_changed_bit_and_every_cut_makes_the_file_void() {
        let whole = file_of(b"compiled");
        assert_eq!(unwrap_data(&whole), Some(b"compiled".as_slice()));
        for bit in 0..8 * whole.len() {
            let mut changed = whole.clone();
            changed[bit / 8] ^= 1 << (bit % 8);
            assert_eq!(unwrap_data(&changed), None, "bit {bit}");
        }
        for end in 0..whole.len() {
            assert_eq!(unwrap_data(&whole[..end]), None, "cut at {end}");
        }
        assert_eq!(
            unwrap_data(&[whole, vec![0]].concat()),
            None,
            "one byte more"
        );
    }

    #[cfg(all(unix, not(target_os = "macos")))]
    #[test]
    fn the_folder_is_where_the_xdg_specification_puts_it() {
        let with = |cache: Option<&'static str>, home: Option<&'static str>| {
            user_folder(|name| match name {
                "XDG_CACHE_HOME" => cache.map(OsString::from),
                "HOME" => home.map(OsString::from),
                _ => None,
            })
        };
        assert_eq!(with(Some("/c"), Some("/h")), Some("/c/stratavox".into()));
        assert_eq!(
            with(Some("c"), Some("/h")),
            Some("/h/.cache/stratavox".into())
        );
        assert_eq!(with(None, Some("/h")), Some("/h/.cache/stratavox".into()));
        assert_eq!(with(Some(""), None), None);
    }
}
