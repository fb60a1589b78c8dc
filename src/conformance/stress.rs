//! The same cases on several threads at once, on the queues of one device: what one thread has found alone, all of them
//! must find together.
//!
//! ```text
//! alone      case 0  case 1  case 2  case 3
//! thread 0   case 0  case 1  case 2  case 3      at the same time,
//! thread 1   case 2  case 3  case 0  case 1      each from another place of the list
//! ```

use super::case::Case;
use super::record::{DeviceRecord, Record, Stress};
use super::supervisor::Outcome;
use super::test_bed::TestBed;
use super::verdict::Verdict;
use super::worker::Answers;
use std::io;
use std::ops::ControlFlow;
use std::thread;

/// Runs `cases` alone, and then on `stress.threads` threads; `stand` makes what the thread of that number works with.
/// `heard` is called with how many records are done. Where it breaks off, no further record is kept.
///
/// # Errors
/// Where pictures cannot be written; where a thread panics.
pub fn run(
    answers: &Answers,
    stress: Stress,
    bed: impl Fn(usize) -> TestBed + Sync,
    cases: &[&Case],
    mut heard: impl FnMut(usize, &mut Record) -> ControlFlow<()>,
) -> io::Result<Outcome> {
    let mut outcome = Outcome::default();
    let mut alone = bed(0);
    let device = alone.device().ok();
    outcome.device = device.map(|device| DeviceRecord::of(device.gpu()));
    let mut records = Vec::with_capacity(cases.len());
    for case in cases {
        records.push(answers.to(case, false, &mut alone)?);
    }
    drop(alone);
    // Pictures are of the run alone.
    let quiet = Answers {
        pictures: None,
        ..*answers
    };
    let work = |number: usize| -> io::Result<Vec<(usize, Record)>> {
        let mut bed = bed(number);
        let first = number * cases.len() / stress.threads as usize;
        let places = (first..cases.len()).chain(0..first);
        places
            .map(|place| Ok((place, quiet.to(cases[place], true, &mut bed)?)))
            .collect()
    };
    let together = thread::scope(|scope| {
        let work = &work;
        let threads: Vec<_> = (0..stress.threads as usize)
            .map(|number| scope.spawn(move || work(number)))
            .collect();
        let ended = |thread: thread::ScopedJoinHandle<'_, _>| {
            let gone = || Err(io::Error::other("a thread of the suite panicked"));
            thread.join().unwrap_or_else(|_| gone())
        };
        threads
            .into_iter()
            .map(ended)
            .collect::<io::Result<Vec<_>>>()
    })?;
    for (number, found) in together.into_iter().enumerate() {
        for (place, record) in found {
            compare(&mut records[place], number, &record);
        }
    }
    for mut record in records {
        let next = heard(outcome.records.len() + 1, &mut record);
        outcome.records.push(record);
        if next.is_break() {
            break;
        }
    }
    Ok(outcome)
}

/// Where a thread has found something else than the run alone, that is a failure, and the first of them is the reason.
fn compare(record: &mut Record, number: usize, found: &Record) {
    record.ms += found.ms;
    record
        .validation_messages
        .extend(found.validation_messages.iter().cloned());
    let alone = record.runs.first().copied().unwrap_or(record.verdict);
    let is_same = found.verdict == alone && found.found_sha256 == record.found_sha256;
    if is_same {
        return;
    }
    if record.runs.is_empty() {
        record.runs.push(alone);
        let why = match found.verdict == alone {
            true => format!(
                "it found {}, alone {}",
                found.found_sha256, record.found_sha256
            ),
            false => format!("it says {}, alone {alone}: {}", found.verdict, found.reason),
        };
        record.reason = format!("under stress, thread {number}: {why}");
    }
    record.runs.push(found.verdict);
    if record.verdict.is_good() {
        record.verdict = match found.verdict.is_good() {
            true => Verdict::Fail,
            false => found.verdict,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::case::Profile;

    #[test]
    fn what_threads_find_otherwise_is_a_failure() {
        use Verdict::{Crash, DeviceLost, Fail, Pass};
        let of = |verdict, sha256: &str| Record {
            found_sha256: sha256.to_owned(),
            ..Record::unmeasured("a", Profile::Full, verdict, String::new())
        };
        for (found, verdict, runs) in [
            (of(Pass, "x"), Pass, vec![]),
            (of(Pass, "y"), Fail, vec![Pass, Pass]),
            (of(DeviceLost, ""), DeviceLost, vec![Pass, DeviceLost]),
        ] {
            let mut record = of(Pass, "x");
            compare(&mut record, 1, &found);
            assert_eq!((record.verdict, &record.runs), (verdict, &runs));
        }
        let mut record = of(Crash, "");
        compare(&mut record, 0, &of(Crash, ""));
        assert_eq!((record.verdict, record.runs.len()), (Crash, 0));
    }
}
