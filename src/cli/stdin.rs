//! The volume on the standard input, `-`, as a file in which readers can seek.

use super::{Error, output::say_aside};
use crate::cli::flags::with_causes;
use std::borrow::Cow;
use std::io::{self, IsTerminal, Read};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock, PoisonError};
use tempfile::NamedTempFile;

/// The standard input in the place of a volume, and the standard output in the place of a picture.
pub const STANDARD: &str = "-";

/// Where that file lies: nobody gave its name, and no message says it.
static PLACE: OnceLock<String> = OnceLock::new();

static SPOOLED: Mutex<Option<NamedTempFile>> = Mutex::new(None);

/// The file that holds what the standard input gave, of at most `max_bytes`. It is read once.
pub fn file(max_bytes: u64) -> Result<PathBuf, Error> {
    let mut spooled = SPOOLED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(file) = &*spooled {
        return Ok(file.path().to_owned());
    }
    if io::stdin().is_terminal() {
        return Err(Error::usage(
            "-: the standard input is a terminal, wanted a volume",
            "cat scan.nii.gz | stratavox render - -o scan.png",
        ));
    }
    let read = |cause: io::Error| Error::Input {
        path: Path::new("the standard input").to_owned(),
        problem: with_causes(&cause),
    };
    let mut file = tempfile::Builder::new()
        .prefix("stratavox-")
        .tempfile()
        .map_err(|cause| Error::output(std::env::temp_dir(), &cause))?;
    let mut input = io::stdin().lock().take(max_bytes.saturating_add(1));
    let bytes = io::copy(&mut input, &mut file).map_err(read)?;
    if bytes > max_bytes {
        return Err(Error::TooMany {
            message: format!(
                "the standard input has more than the {max_bytes} bytes that are allowed"
            ),
            hint: "--max-memory 16G allows more, where --untrusted does not forbid it",
        });
    }
    say_aside(&format!("read {bytes} bytes from the standard input"));
    let path = file.path().to_owned();
    let _ = PLACE.set(path.display().to_string());
    *spooled = Some(file);
    Ok(path)
}

/// A message with the file called by what it holds.
pub fn named(text: &str) -> Cow<'_, str> {
    match PLACE.get() {
        Some(place) => text.replace(place, "the standard input").into(),
        None => text.into(),
    }
}

/// Removes the file, when the program ends.
pub fn discard() {
    // A thread that is just reading holds the lock, and its file is nobody's yet.
    if let Ok(mut spooled) = SPOOLED.try_lock() {
        spooled.take();
    }
}
