//! Calls into decoders that others wrote: a panic in one is an error about the file, not the end of the program.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

thread_local! {
    static DEPTH: Cell<u32> = const { Cell::new(0) };
}

/// What `call` gives; where it panics, the words of the panic. What it touched is not to be looked at after that.
#[cfg(feature = "files")]
pub(crate) fn fenced<T>(call: impl FnOnce() -> T) -> Result<T, String> {
    DEPTH.set(DEPTH.get() + 1);
    let outcome = catch_unwind(AssertUnwindSafe(call));
    DEPTH.set(DEPTH.get() - 1);
    outcome.map_err(|panic| {
        let words = panic.downcast_ref::<String>().map(String::as_str);
        let words = words.or_else(|| panic.downcast_ref::<&str>().copied());
        words.unwrap_or("the decoder gave up").to_owned()
    })
}

/// True on a thread that is inside such a call: a program's panic hook has nothing to report there.
#[cfg(feature = "cli")]
pub(crate) fn is_inside() -> bool {
    DEPTH.get() > 0
}

#[cfg(all(test, feature = "cli"))]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_its_words_and_the_fence_is_left() {
        let failed = fenced(|| {
            assert!(is_inside());
            let inner: Result<(), String> = fenced(|| panic!("index {}", 7));
            assert_eq!(inner, Err("index 7".to_owned()));
            assert!(is_inside());
            3
        });
        assert_eq!(failed, Ok(3));
        assert!(!is_inside());
    }
}
