//! What is said at the end of a run.

use super::super::{Error, output::say};
use crate::conformance::baseline::Change;
use crate::conformance::record::Package;
use crate::conformance::verdict::Verdict;

/// The summary, and exit code 1 where a case fails the run.
pub fn tell(package: &Package) -> Result<(), Error> {
    let device = package.device.as_ref();
    let name = device.map_or("no device", |device| &device.name);
    let count = package.cases.len();
    let mut text = format!("{name}: {count} cases in {:.1} s\n", package.seconds);
    for verdict in Verdict::ALL {
        if let Some(count) = package.summary.get(&verdict) {
            text.push_str(&format!("  {verdict:<16} {count}\n"));
        }
    }
    let weak = package.cases.iter().filter(|record| record.weak_bound);
    let weak = weak.count();
    if weak > 0 {
        text.push_str(&format!(
            "  {weak} of them prove little: a tenth of their channels may be off by half a code of 255 or more\n"
        ));
    }
    for record in &package.cases {
        let name = &record.name;
        if record.unexpected_pass {
            text.push_str(&format!("  {name} passes, and a waiver says it does not\n"));
        }
        if let (Some(change), Some(then)) = (Change::of(record), record.baseline) {
            let (change, now) = (change.word(), record.verdict);
            text.push_str(&format!(
                "  {change}: {name}: {now}, {then} in the baseline\n"
            ));
        }
    }
    if package.is_partial {
        text.push_str("  the run ended before all of its cases had run\n");
    }
    say(&text)?;
    let bad = package
        .cases
        .iter()
        .filter(|record| record.verdict.fails_run());
    match bad.count() {
        0 => Ok(()),
        bad => Err(Error::Differs(format!(
            "{bad} of {count} cases are not well"
        ))),
    }
}
