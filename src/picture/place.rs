//! Files that appear whole or not at all: a temporary file in the same folder, written, synced, renamed.

use super::write::OutputProblem;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

/// A file written under a temporary name; gone again unless published.
pub(super) struct Staged {
    file: tempfile::NamedTempFile,
    folder: PathBuf,
    path: PathBuf,
    replace: bool,
}

/// Writes `bytes` beside `path`; an existing file is an error unless `replace`.
pub(super) fn stage(path: &Path, bytes: &[u8], replace: bool) -> Result<Staged, OutputProblem> {
    let Some(name) = path.file_name() else {
        return Err(OutputProblem::NoName);
    };
    if path.is_dir() {
        return Err(OutputProblem::IsFolder);
    }
    // A link counts as existing even where it leads nowhere.
    if !replace && path.symlink_metadata().is_ok() {
        return Err(OutputProblem::Exists);
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        return Err(OutputProblem::NoFolder(folder.to_owned()));
    }
    let mut prefix = std::ffi::OsString::from(".");
    prefix.push(name);
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(".part");
    // The system takes the user's mask off; a temporary file alone would stay private.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let doing = |doing| move |cause| OutputProblem::Io { doing, cause };
    let mut file = builder
        .tempfile_in(folder)
        .map_err(doing("cannot make a file in its folder"))?;
    file.write_all(bytes)
        .map_err(|cause| OutputProblem::Write {
            wanted_bytes: bytes.len() as u64,
            cause,
        })?;
    file.as_file()
        .sync_all()
        .map_err(doing("cannot bring the file to the disk"))?;
    Ok(Staged {
        file,
        folder: folder.to_owned(),
        path: path.to_owned(),
        replace,
    })
}

impl Staged {
    /// Gives the file its name.
    pub(super) fn publish(self) -> Result<(), OutputProblem> {
        let renamed = if self.replace {
            self.file.persist(&self.path)
        } else {
            self.file.persist_noclobber(&self.path)
        };
        renamed.map_err(|failed| match failed.error.kind() {
            std::io::ErrorKind::AlreadyExists => OutputProblem::Exists,
            _ => OutputProblem::Io {
                doing: "cannot rename the finished file",
                cause: failed.error,
            },
        })?;
        // Without this the name may be lost with the power; where folders cannot be opened, it may.
        #[cfg(unix)]
        File::open(&self.folder)
            .and_then(|folder| folder.sync_all())
            .map_err(|cause| OutputProblem::Io {
                doing: "cannot bring the folder to the disk",
                cause,
            })?;
        Ok(())
    }
}
