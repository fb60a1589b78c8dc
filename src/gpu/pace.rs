//! How much of some work the next submission takes, so that it lasts some 100 ms.
//!
//! ```text
//! n_next = min(target / rate, 2 n)        rate = ms / n of all so far, or where that of the last submission is larger
//!                                                the mean of both, or after one that took too long the larger one
//! ```
//!
//! A watchdog ends what holds a device for seconds (2 s on Windows), and a desktop stands still meanwhile. What
//! follows may be more expensive than what was measured: so work only doubles. Other programs make single times long: one of
//! them alone does not make all that follows small.

use std::ops::Range;

/// How long a submission shall take.
pub const TARGET_MS: f64 = 100.0;

/// A submission that takes so many times what it should tells that the work has become more expensive.
const TOO_LONG: f64 = 1.5;

/// Some work, counted in units that may lie in different submissions.
#[derive(Clone, Debug)]
pub struct Pace {
    units: u64,
    done: u64,
    /// Units of the next submission, where as many are left.
    size: u64,
    target_ms: f64,
    spent_ms: f64,
}

impl Pace {
    /// So many units, which are expected to take so long together.
    pub fn new(units: u64, expected_ms: f64, target_ms: f64) -> Self {
        Self {
            units,
            done: 0,
            size: size_of_share(units, target_ms / expected_ms),
            target_ms,
            spent_ms: 0.0,
        }
    }

    /// The units of the next submission; `None`: all are done.
    pub fn next(&self) -> Option<Range<u64>> {
        let left = self.units - self.done;
        if left == 0 {
            return None;
        }
        // A quarter more rather than a small rest, and submissions of one size rather than a small last one.
        let count = match self.size.saturating_add(self.size / 4) {
            enough if enough >= left => left,
            _ => left.div_ceil(left.div_ceil(self.size)),
        };
        Some(self.done..self.done + count)
    }

    /// How long they took.
    pub fn took(&mut self, units: Range<u64>, ms: f64) {
        let count = units.end - units.start;
        self.done = units.end;
        self.spent_ms += ms;
        let (last, all) = (ms / count as f64, self.spent_ms / self.done as f64);
        let rate = match ms > TOO_LONG * self.target_ms {
            true => last.max(all),
            false => all.max(0.5 * (last + all)),
        };
        self.size = (self.target_ms / rate).min(2.0 * count as f64).max(1.0) as u64;
    }

    /// The part of the work that is done, 0 to 1.
    pub fn part(&self) -> f64 {
        self.done as f64 / self.units.max(1) as f64
    }

    /// What all submissions took.
    pub fn spent_ms(&self) -> f64 {
        self.spent_ms
    }
}

/// At least one unit, at most all; a share that is no number is all.
fn size_of_share(units: u64, share: f64) -> u64 {
    match share < 1.0 {
        true => ((units as f64 * share) as u64).max(1),
        false => units.max(1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The times of all submissions of work whose unit number i takes `cost(i)` ms.
    fn submissions(units: u64, expected_ms: f64, cost: impl Fn(u64) -> f64) -> Vec<f64> {
        let mut pace = Pace::new(units, expected_ms, TARGET_MS);
        let mut times = Vec::new();
        let mut seen = 0;
        while let Some(range) = pace.next() {
            assert_eq!(range.start, seen, "each unit once, in order");
            assert!(range.end > range.start && range.end <= units);
            seen = range.end;
            times.push(range.clone().map(&cost).sum());
            pace.took(range, times[times.len() - 1]);
        }
        assert_eq!(seen, units, "all of them");
        times
    }

    fn longest(times: &[f64]) -> f64 {
        times.iter().copied().fold(0.0, f64::max)
    }

    #[test]
    fn what_is_expected_to_take_less_than_the_target_is_one_submission() {
        for expected in [0.0, 1.0, 99.0] {
            assert_eq!(submissions(4096, expected, |_| 1e-3).len(), 1);
        }
        assert_eq!(submissions(1, 1e9, |_| 5.0).len(), 1);
        assert_eq!(submissions(0, 1e9, |_| 5.0).len(), 0);
    }

    #[test]
    fn submissions_come_to_last_as_long_as_wanted() {
        // 20 s of work, expected to be ten times as much, as much, and a tenth.
        for expected in [2e5, 2e4, 2e3] {
            let times = submissions(20_000, expected, |_| 1.0);
            let settled = &times[times.len() / 2..times.len() - 1];
            for &ms in settled {
                assert!((90.0..=125.0).contains(&ms), "{expected}: {times:?}");
            }
            let allowed = 200 + 10;
            assert!(times.len() <= allowed, "{expected}: {}", times.len());
        }
    }

    #[test]
    fn what_was_thought_ten_times_as_dear_takes_three_submissions_more_at_most() {
        // 80 ms in all.
        assert!(submissions(64, 800.0, |_| 80.0 / 64.0).len() <= 4);
        // 40 ms.
        assert!(submissions(64, 400.0, |_| 40.0 / 64.0).len() <= 3);
    }

    #[test]
    fn a_part_a_hundred_times_as_dear_as_the_rest_does_not_make_one_long_submission() {
        use crate::gpu::Blocks;
        // Rows of a picture of 1024 x 1024 pixels, cheap but for a band of any height anywhere; first guesses are for
        // the expensive ones, as those of pictures are for rays that skip nothing.
        let blocks = Blocks::new([1024, 1024], [1, 128]);
        let rows = blocks.count();
        for height in [1, 2, 3, 5, 8, 16, 40, 128] {
            for first in 0..rows - height {
                for cheap_ms in [0.01, 0.1, 0.5] {
                    let cost = |unit: u64| {
                        let row = u64::from(blocks.tiles(unit..unit + 1)[0].origin[1]) / 8;
                        match (first..first + height).contains(&row) {
                            true => 100.0 * cheap_ms,
                            false => cheap_ms,
                        }
                    };
                    let expected = rows as f64 * 100.0 * cheap_ms;
                    let times = submissions(rows, expected, cost);
                    let found = longest(&times);
                    let allowed = 250.0;
                    assert!(
                        found <= allowed,
                        "{height} rows from {first}, {cheap_ms} ms: {times:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_unit_that_takes_too_long_by_itself_is_a_submission_by_itself() {
        let times = submissions(64, 64.0 * 300.0, |_| 300.0);
        assert_eq!(times.len(), 64);
    }

    #[test]
    fn no_time_at_all_and_no_number_do_no_harm() {
        assert!(submissions(1000, 1e6, |_| 0.0).len() < 20);
        assert_eq!(submissions(1000, f64::NAN, |_| 1.0).len(), 1);
        assert_eq!(submissions(1000, f64::INFINITY, |_| 0.1).len(), 10);
    }
}
