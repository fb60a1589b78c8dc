//! Calls into decoders that others wrote, as errors of a format.

use super::problem::{escape, invalid};
use crate::volume::Problem;

/// What `call` gives. `what` names the part of the file that it reads.
pub(crate) fn fenced<T>(
    format: &'static str,
    what: &str,
    call: impl FnOnce() -> Result<T, Problem>,
) -> Result<T, Problem> {
    let wanted = "bytes that its decoder understands";
    crate::fence::fenced(call)
        .unwrap_or_else(|words| Err(invalid(format, what, wanted, &escape(&words))))
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
