//! Calls into decoders that others wrote: a panic in one is an error about the file, not the end of the program.

use super::problem::{escape, invalid};
use crate::volume::Problem;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What `call` gives. `what` names the part of the file that it reads.
pub(crate) fn fenced<T>(
    format: &'static str,
    what: &str,
    call: impl FnOnce() -> Result<T, Problem>,
) -> Result<T, Problem> {
    // What a panic leaves behind is only asked again through a fence.
    catch_unwind(AssertUnwindSafe(call)).unwrap_or_else(|panic| {
        let word = panic
            .downcast_ref::<String>()
            .map(String::as_str)
            .or_else(|| panic.downcast_ref::<&str>().copied());
        Err(invalid(
            format,
            what,
            "bytes that its decoder understands",
            &escape(word.unwrap_or("a panic of the decoder")),
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_an_error_that_names_the_part() {
        let error = fenced::<()>("hdf5", "`a`", || panic!("index {}", 7)).unwrap_err();
        let text = error.to_string();
        assert!(text.contains("`a`") && text.contains("index 7"), "{text}");
        assert_eq!(fenced("hdf5", "`a`", || Ok(3)).unwrap(), 3);
    }
}
