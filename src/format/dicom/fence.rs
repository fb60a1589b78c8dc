//! A fence around decoders that others wrote: a panic in one is a damaged file, not the end of the program.

use super::pixels::damaged;
use crate::volume::Problem;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs `decode`. Nothing that it touched is looked at after a panic.
pub(super) fn fenced<T>(
    encoding: &'static str,
    decode: impl FnOnce() -> Result<T, Problem>,
) -> Result<T, Problem> {
    catch_unwind(AssertUnwindSafe(decode))
        .unwrap_or_else(|_| Err(damaged(encoding, "the decoder gave up on it")))
}
