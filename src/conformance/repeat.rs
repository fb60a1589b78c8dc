//! A case that runs several times, and what is said of it then.

use super::record::Record;
use super::verdict::Verdict;
use std::num::NonZero;

/// The record of a case that `ask` runs `times` times; it is told whether the case ran before.
///
/// The first run that is not well stands for all, else the first. Where verdicts differ the record holds all of them.
/// Where verdicts are the same and the numbers that were found are not, a good one becomes `fail`: the same commands
/// on the same state have the same result (Vulkan specification, Invariance, Repeatability).
///
/// # Errors
/// Those of `ask`.
pub fn repeated<E>(
    times: NonZero<u32>,
    mut ask: impl FnMut(bool) -> Result<Record, E>,
) -> Result<Record, E> {
    let mut kept = ask(false)?;
    if times.get() == 1 {
        return Ok(kept);
    }
    let first_sha256 = kept.found_sha256.clone();
    let mut runs = vec![kept.verdict];
    let mut other: Option<(u32, String)> = None;
    let mut ms = kept.ms;
    for nth in 2..=times.get() {
        let record = ask(true)?;
        ms += record.ms;
        runs.push(record.verdict);
        if record.found_sha256 != first_sha256 && other.is_none() {
            other = Some((nth, record.found_sha256.clone()));
        }
        if kept.verdict.is_good() && !record.verdict.is_good() {
            kept = record;
        }
    }
    kept.ms = ms;
    if runs.iter().any(|&verdict| verdict != runs[0]) {
        kept.reason = format!("flaky, in {times} runs: {}", kept.reason);
        kept.runs = runs;
    } else if let Some((nth, sha256)) = other {
        let why = format!("flaky, run {nth} of {times} found {sha256}, the first {first_sha256}");
        kept.reason = match kept.reason.as_str() {
            "" => why,
            reason => format!("{why}: {reason}"),
        };
        if kept.verdict.is_good() {
            kept.verdict = Verdict::Fail;
        }
        kept.runs = runs;
    }
    Ok(kept)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::case::Profile;

    fn said(runs: &[(Verdict, &str)]) -> Record {
        let mut left = runs.iter();
        let times = NonZero::new(runs.len() as u32).unwrap();
        let ask = |_| -> Result<Record, ()> {
            let (verdict, sha256) = left.next().ok_or(())?;
            let mut record = Record::unmeasured("a", Profile::Full, *verdict, String::new());
            record.found_sha256 = (*sha256).to_owned();
            record.ms = 1.0;
            Ok(record)
        };
        repeated(times, ask).unwrap()
    }

    #[test]
    fn runs_that_agree_are_one_record_and_others_are_a_flake() {
        use Verdict::{Crash, Fail, Pass};
        let same = said(&[(Pass, "x"), (Pass, "x"), (Pass, "x")]);
        assert_eq!((same.verdict, same.runs.len(), same.ms), (Pass, 0, 3.0));
        let late = said(&[(Pass, "x"), (Pass, "x"), (Crash, "")]);
        assert_eq!(late.verdict, Crash);
        assert_eq!(late.runs, [Pass, Pass, Crash]);
        let numbers = said(&[(Pass, "x"), (Pass, "y")]);
        assert_eq!((numbers.verdict, numbers.runs.len()), (Fail, 2));
        assert!(numbers.reason.contains("run 2 of 2"), "{}", numbers.reason);
        let wrong = said(&[(Fail, "x"), (Fail, "x")]);
        assert_eq!((wrong.verdict, wrong.runs.len()), (Fail, 0));
    }
}
