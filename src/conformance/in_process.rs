//! Cases run in this very process, one after the other: for debuggers and tools that capture what a process does. A
//! case that crashes ends the run, and one that hangs does not end.

use super::case::Case;
use super::record::{DeviceRecord, Record};
use super::repeat::repeated;
use super::supervisor::Outcome;
use super::test_bed::TestBed;
use super::worker::Answers;
use std::io;
use std::num::NonZero;
use std::ops::ControlFlow;

/// Runs `cases`, each `repeat` times; `heard` is called after each with how many are done. Where it breaks off, no
/// further case begins.
///
/// # Errors
/// Where pictures cannot be written.
pub fn run(
    answers: &Answers,
    bed: &mut TestBed,
    cases: &[&Case],
    repeat: NonZero<u32>,
    mut heard: impl FnMut(usize, &mut Record) -> ControlFlow<()>,
) -> io::Result<Outcome> {
    let mut outcome = Outcome::default();
    for case in cases {
        if outcome.device.is_none() {
            let device = bed.device().ok();
            outcome.device = device.map(|device| DeviceRecord::of(device.gpu()));
        }
        let mut record = repeated(repeat, |is_again| answers.to(case, is_again, bed))?;
        let next = heard(outcome.records.len() + 1, &mut record);
        outcome.records.push(record);
        if next.is_break() {
            break;
        }
    }
    Ok(outcome)
}
