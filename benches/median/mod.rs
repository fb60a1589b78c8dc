//! The middle of several runs: one that was disturbed does not count.

#![allow(dead_code, reason = "each bench uses its part")]

use std::time::Instant;

/// Milliseconds, the median of `runs` after one that is not counted: first use compiles and allocates.
pub fn median_of<T>(runs: usize, mut work: impl FnMut() -> T) -> f64 {
    std::hint::black_box(work());
    let time = |_| {
        let start = Instant::now();
        std::hint::black_box(work());
        1e3 * start.elapsed().as_secs_f64()
    };
    median((0..runs).map(time).collect())
}

/// The middle of some numbers.
pub fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}
