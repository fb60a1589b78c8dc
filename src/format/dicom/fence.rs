//! A fence around decoders that others wrote: a panic in one is a damaged file, not the end of the program.

use super::pixels::damaged;
use crate::format::problem::escape;
use crate::volume::Problem;

/// Runs `decode`. Nothing that it touched is looked at after a panic.
pub(super) fn fenced<T>(
    encoding: &'static str,
    decode: impl FnOnce() -> Result<T, Problem>,
) -> Result<T, Problem> {
    crate::fence::fenced(decode).unwrap_or_else(|words| Err(damaged(encoding, escape(&words))))
}
