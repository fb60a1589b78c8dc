//! Files of words beside volumes: read whole, and never more than they may hold.

use super::Error;
use std::{fs::File, io::Read, path::Path};

/// The bytes of the file at `path`, `what` as in "a scene", and what `parse` makes of them.
///
/// # Errors
/// [`Error::Input`] where it cannot be read, holds more than `max_bytes`, or says something wrong.
pub fn parsed<T>(
    path: &Path,
    what: &str,
    max_bytes: u64,
    parse: impl FnOnce(&[u8]) -> Result<T, String>,
) -> Result<T, Error> {
    let refused = |problem| Error::Input {
        path: path.to_owned(),
        problem,
    };
    let mut bytes = Vec::new();
    File::open(path)
        .and_then(|file| file.take(max_bytes + 1).read_to_end(&mut bytes))
        .map_err(|cause| refused(cause.to_string()))?;
    if bytes.len() as u64 > max_bytes {
        return Err(refused(format!("{what} has at most {max_bytes} bytes")));
    }
    parse(&bytes).map_err(refused)
}
