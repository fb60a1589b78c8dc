//! What is made of each record when it comes: how to run its case again, what is known of it, and whether to go on.

use super::super::output::say_aside;
use crate::conformance::baseline::{Baseline, Change};
use crate::conformance::case::Profile;
use crate::conformance::record::{DeviceRecord, Record};
use crate::conformance::waiver::{Waivers, today};
use std::io::{IsTerminal, Write};
use std::ops::ControlFlow;

/// What is known before the first record comes.
#[derive(Debug)]
pub struct Hearing {
    /// The words behind `--filter NAME` that run a case again.
    pub again: String,
    pub waivers: Waivers,
    pub baseline: Option<Baseline>,
    pub device: DeviceRecord,
    /// Ends the run with the first case that fails it.
    pub stops_on_fail: bool,
    /// How many cases there are.
    pub cases: usize,
}

impl Hearing {
    /// Completes a record, the `done`th, and says on stderr what is not well.
    pub fn hear(&self, done: usize, record: &mut Record) -> ControlFlow<()> {
        let profile = match record.profile {
            Profile::Baseline => String::new(),
            profile => format!(" --profile {}", profile.word()),
        };
        record.command = format!(
            "stratavox conformance --filter {}{profile}{}",
            record.name, self.again
        );
        self.waivers.apply(record, &self.device, today());
        if let Some(baseline) = &self.baseline {
            baseline.apply(record);
        }
        if record.verdict.fails_run() {
            let change = Change::of(record).map(|change| format!(" ({})", change.word()));
            let (name, verdict) = (&record.name, record.verdict);
            let change = change.unwrap_or_default();
            say_aside(&format!("{verdict}: {name}{change}: {}", record.reason));
            say_aside(&format!("again: {}", record.command));
        }
        if std::io::stderr().is_terminal() {
            let end = if done == self.cases { "\n" } else { "" };
            let mut err = std::io::stderr();
            let _ = write!(err, "\r{done} of {} cases{end}", self.cases);
        }
        match self.stops_on_fail && record.verdict.fails_run() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}

/// A word as a shell reads it.
pub fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "_-./:=,@%+".contains(c);
    match !word.is_empty() && word.chars().all(is_plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', r"'\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn a_shell_reads_back_what_was_quoted() {
        assert_eq!(quoted("llvmpipe"), "llvmpipe");
        assert_eq!(quoted("a b"), "'a b'");
        assert_eq!(quoted("a'b"), r"'a'\''b'");
        assert_eq!(quoted(""), "''");
    }
}
