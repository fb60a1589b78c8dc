//! Which files may be opened: regular ones, and from inside a header only those under the header's folder.

use super::problem::{self, at, escape, invalid};
use crate::volume::{Limits, Problem, ReadError};
use std::fs::{File, FileType, Metadata};
use std::io::{BufRead, BufReader, ErrorKind, Read, Seek, SeekFrom};
use std::path::{Component, Path, PathBuf};

/// Opens a regular file. A folder, a pipe or a device is refused before it is opened: opening a pipe waits.
pub(crate) fn open_regular(path: &Path) -> Result<(File, Metadata), Problem> {
    let before = std::fs::metadata(path).map_err(problem::io("looking for the file"))?;
    if !before.is_file() {
        return Err(Problem::UnknownFormat(format!(
            ": this is {}, a file was wanted",
            kind(before.file_type())
        )));
    }
    let file = File::open(path).map_err(problem::io("opening the file"))?;
    let metadata = file
        .metadata()
        .map_err(problem::io("asking for the file's length"))?;
    Ok((file, metadata))
}

/// All bytes of a file that has at most so many; `what` it is.
#[cfg(feature = "json")]
pub(crate) fn whole(path: &Path, most: u64, what: &str) -> Result<Vec<u8>, Problem> {
    let (file, metadata) = open_regular(path)?;
    let mut bytes = Vec::new();
    // It may grow while it is read.
    let found = file.take(most.saturating_add(1)).read_to_end(&mut bytes);
    found.map_err(problem::io("reading the file"))?;
    let count = super::convert::to_u64(bytes.len()).max(metadata.len());
    match count > most {
        true => Err(Problem::Limit {
            what: what.to_owned(),
            wanted_bytes: count,
            limit_bytes: most,
        }),
        false => Ok(bytes),
    }
}

fn kind(file_type: FileType) -> &'static str {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        if file_type.is_fifo() {
            return "a pipe";
        }
        if file_type.is_socket() {
            return "a socket";
        }
        if file_type.is_block_device() || file_type.is_char_device() {
            return "a device";
        }
    }
    if file_type.is_dir() {
        "a folder"
    } else {
        "no regular file"
    }
}

/// Resolves names that a header gives, under the header's folder.
pub(crate) struct Folder {
    /// As the caller wrote it: for messages.
    given: PathBuf,
    /// With every link followed: what a name may not leave.
    real: PathBuf,
}

impl Folder {
    /// The folder that `header` lies in, where `limits` let a header of `format` name other files.
    pub(crate) fn of(
        header: &Path,
        format: &'static str,
        limits: &Limits,
    ) -> Result<Self, Problem> {
        if !limits.detached {
            let what =
                "a header that names another file, where limits are those for untrusted files,";
            return Err(problem::unsupported(format, what));
        }
        let given = match header.parent() {
            Some(parent) if parent != Path::new("") => parent.to_owned(),
            _ => PathBuf::from("."),
        };
        let real = given
            .canonicalize()
            .map_err(problem::io("looking for the folder of the header"))?;
        Ok(Self { given, real })
    }

    /// The file that `name` means. Absolute names, `..` and links out of the folder are refused.
    pub(crate) fn resolve(
        &self,
        name: &str,
        format: &'static str,
        field: &str,
    ) -> Result<PathBuf, ReadError> {
        let wanted = "the name of a file in the header's folder";
        let inside = !name.is_empty()
            && !name.contains('\0')
            && Path::new(name)
                .components()
                .all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
        if !inside {
            return Err(at(&self.given)(invalid(format, field, wanted, name)));
        }
        let path = self.given.join(name);
        // What a message repeats must not carry control characters from the file.
        let shown = self.given.join(escape(name));
        let real = path.canonicalize().map_err(|cause| {
            at(&shown)(match cause.kind() {
                ErrorKind::NotFound => invalid(format, field, "a file that is there", name),
                _ => problem::io("looking for the file that the header names")(cause),
            })
        })?;
        if !real.starts_with(&self.real) {
            return Err(at(&shown)(invalid(
                format,
                field,
                "a file in the header's folder, not a link out of it",
                name,
            )));
        }
        Ok(path)
    }
}

/// Where in `path` the `lines`th line after byte `start` begins.
pub(crate) fn offset_after_lines(path: &Path, start: u64, lines: u64) -> Result<u64, Problem> {
    let reading = "skipping lines of the data file";
    let (mut file, metadata) = open_regular(path)?;
    if lines > metadata.len() {
        return Err(too_few_lines(lines));
    }
    file.seek(SeekFrom::Start(start))
        .map_err(problem::io(reading))?;
    let mut input = BufReader::new(file);
    let mut offset = start;
    for _ in 0..lines {
        let skipped = skip_line(&mut input).map_err(problem::io(reading))?;
        offset = offset.saturating_add(skipped.ok_or_else(|| too_few_lines(lines))?);
    }
    Ok(offset)
}

fn too_few_lines(lines: u64) -> Problem {
    Problem::Invalid {
        format: "nrrd",
        field: "line skip".to_owned(),
        wanted: "no more lines than the data file has".to_owned(),
        found: lines.to_string(),
    }
}

/// Bytes of the line that was passed over; `None` where there was no line end.
fn skip_line(input: &mut impl BufRead) -> std::io::Result<Option<u64>> {
    let mut bytes = 0_u64;
    loop {
        let available = input.fill_buf()?;
        if available.is_empty() {
            return Ok(None);
        }
        let end = available.iter().position(|&byte| byte == b'\n');
        let used = end.map_or(available.len(), |at| at.saturating_add(1));
        input.consume(used);
        bytes = bytes.saturating_add(u64::try_from(used).unwrap_or(u64::MAX));
        if end.is_some() {
            return Ok(Some(bytes));
        }
    }
}

/// At most the first `length` bytes of a file.
pub(crate) fn first_bytes(file: &mut File, length: u64) -> Result<Vec<u8>, Problem> {
    let mut bytes = Vec::new();
    file.take(length)
        .read_to_end(&mut bytes)
        .map_err(problem::io("reading the first bytes"))?;
    Ok(bytes)
}
