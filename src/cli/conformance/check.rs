//! Packages that are there already: looked through, and compared.

use super::super::{Error, error::visible, output::say};
use crate::conformance::difference::Difference;
use crate::conformance::record::Package;
use crate::conformance::tree::cases;
use std::path::Path;

/// Says what is wrong with a package, exit code 1, or that nothing is.
pub fn verify(path: &Path, is_part: bool) -> Result<(), Error> {
    let package = read(path)?;
    let complaints = match is_part {
        true => package.complaints_of_part(&cases()),
        false => package.complaints(&cases()),
    };
    let asked = &package.asked;
    if complaints.is_empty() {
        let device = package.device.as_ref().map_or("", |device| &device.name);
        return say(&format!(
            "{}: {} cases of profile {} on {}, nothing is wrong with it\n",
            path.display(),
            package.cases.len(),
            asked.selection.profile.word(),
            visible(device)
        ));
    }
    const MOST_SHOWN: usize = 40;
    let shown = complaints.iter().take(MOST_SHOWN);
    let lines: String = shown.map(|line| format!("{}\n", visible(line))).collect();
    say(&lines)?;
    Err(Error::Differs(format!(
        "{}: {} things are wrong with it",
        path.display(),
        complaints.len()
    )))
}

/// Says how two packages differ; exit code 1 where they say other things of a case.
pub fn diff(a: &Path, b: &Path) -> Result<(), Error> {
    let difference = Difference::of(&read(a)?, &read(b)?);
    say(&difference.text())?;
    match difference.agrees() {
        true => Ok(()),
        false => Err(Error::Differs(format!(
            "{} and {} say other things of {} cases",
            a.display(),
            b.display(),
            difference.verdicts.len() + difference.alone.len()
        ))),
    }
}

/// A package that `--json` has written.
pub fn read(path: &Path) -> Result<Package, Error> {
    let wrong = |problem: String| Error::Input {
        path: path.to_owned(),
        problem,
    };
    let text = std::fs::read_to_string(path).map_err(|cause| wrong(cause.to_string()))?;
    serde_json::from_str(&text).map_err(|cause| wrong(format!("it is no package: {cause}")))
}
