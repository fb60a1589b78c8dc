//! How much of a sweep is tried: a share that takes seconds, and all of it with `STRATAVOX_SWEEP=long` (`make sweep`).

#![allow(dead_code, reason = "each test program uses its part")]

/// Whether all is tried.
pub fn is_long() -> bool {
    std::env::var_os("STRATAVOX_SWEEP").is_some_and(|sweep| sweep == "long")
}

/// How many of so many random cases are tried: one of three.
pub fn share(cases: usize) -> usize {
    if is_long() { cases } else { cases.div_ceil(3) }
}
