//! Files that appear whole or not at all: a temporary file in the same folder, written, synced, renamed.

use super::write::{OutputError, OutputProblem};
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// A file written under a temporary name; gone again unless published.
#[derive(Debug)]
pub struct OutputFile {
    file: tempfile::NamedTempFile,
    folder: PathBuf,
    path: PathBuf,
    replace: bool,
}

/// Writes `bytes` beside `path`; an existing file is an error unless `replace`.
pub(super) fn stage(path: &Path, bytes: &[u8], replace: bool) -> Result<OutputFile, OutputProblem> {
    let mut staged = OutputFile::begin(path, replace)?;
    staged
        .write_all(bytes)
        .map_err(|cause| OutputProblem::Write {
            wanted_bytes: bytes.len() as u64,
            cause,
        })?;
    // Before any of several files gets its name, all are on the disk.
    staged
        .file
        .as_file()
        .sync_all()
        .map_err(|cause| OutputProblem::Io {
            doing: "cannot bring the file to the disk",
            cause,
        })?;
    Ok(staged)
}

impl OutputFile {
    /// A file that will be at `path`; an existing one is an error unless `replace`.
    ///
    /// # Errors
    /// Where there is no folder for it, the system lets nobody write there, or the name is taken.
    pub fn create(path: &Path, replace: bool) -> Result<Self, OutputError> {
        Self::begin(path, replace).map_err(|problem| OutputError {
            path: path.to_owned(),
            problem,
        })
    }

    fn begin(path: &Path, replace: bool) -> Result<Self, OutputProblem> {
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
        let file = builder
            .tempfile_in(folder)
            .map_err(|cause| OutputProblem::Io {
                doing: "cannot make a file in its folder",
                cause,
            })?;
        Ok(Self {
            file,
            folder: folder.to_owned(),
            path: path.to_owned(),
            replace,
        })
    }

    /// The temporary name: what to remove where the process ends without warning.
    pub fn part(&self) -> &Path {
        self.file.path()
    }

    /// Brings the file to the disk and gives it its name.
    ///
    /// # Errors
    /// Where the system would not, or a file with this name has come into being meanwhile.
    pub fn publish(self) -> Result<(), OutputError> {
        let path = self.path.clone();
        self.sync_and_rename()
            .map_err(|problem| OutputError { path, problem })
    }

    fn sync_and_rename(self) -> Result<(), OutputProblem> {
        let doing = |doing| move |cause| OutputProblem::Io { doing, cause };
        self.file
            .as_file()
            .sync_all()
            .map_err(doing("cannot bring the file to the disk"))?;
        let renamed = if self.replace {
            self.file.persist(&self.path)
        } else {
            self.file.persist_noclobber(&self.path)
        };
        renamed.map_err(|failed| match failed.error.kind() {
            io::ErrorKind::AlreadyExists => OutputProblem::Exists,
            _ => OutputProblem::Io {
                doing: "cannot rename the finished file",
                cause: failed.error,
            },
        })?;
        // Without this the name may be lost with the power; where folders cannot be opened, it may.
        if cfg!(unix) {
            File::open(&self.folder)
                .and_then(|folder| folder.sync_all())
                .map_err(doing("cannot bring the folder to the disk"))?;
        }
        Ok(())
    }
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.as_file_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_file_mut().flush()
    }
}

impl Read for OutputFile {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.file.as_file_mut().read(bytes)
    }
}

impl Seek for OutputFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.as_file_mut().seek(to)
    }
}
