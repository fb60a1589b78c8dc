//! What an earlier run has found: failures of then are expected, and what was well then and is not now is a regression.

use super::record::{Asked, Package, Record};
use super::verdict::Verdict;
use std::collections::HashMap;

/// The verdicts of an earlier run, by the names of its cases.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Baseline(HashMap<String, Verdict>);

impl Baseline {
    /// Of a package, for a run of what is `asked`.
    ///
    /// # Errors
    /// Where the two are not runs of the same numbers.
    pub fn of(package: &Package, asked: &Asked) -> Result<Self, String> {
        let then = &package.asked;
        if then.seed != asked.seed {
            let (found, wanted) = (then.seed, asked.seed);
            return Err(format!(
                "seed: wanted {wanted} as of this run, found {found}"
            ));
        }
        if then.limits != asked.limits {
            let (found, wanted) = (&then.limits, &asked.limits);
            return Err(format!(
                "limits: wanted {wanted} as of this run, found {found}"
            ));
        }
        let verdict = |record: &Record| match (record.verdict, record.baseline) {
            (Verdict::ExpectedFailure, Some(verdict)) => verdict,
            (verdict, _) => verdict,
        };
        let all = package.cases.iter();
        Ok(Self(
            all.map(|record| (record.name.clone(), verdict(record)))
                .collect(),
        ))
    }

    /// Notes what was found of the case then. A failure that is the same as then becomes `expected_failure`.
    pub fn apply(&self, record: &mut Record) {
        record.baseline = self.0.get(&record.name).copied();
        if !record.verdict.is_good() && record.baseline == Some(record.verdict) {
            record.verdict = Verdict::ExpectedFailure;
        }
    }
}

/// How a case is beside an earlier run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// It was well and is not.
    Regression,
    /// It failed, and is well.
    Fixed,
    /// It failed in another way.
    OtherFailure,
    /// It ran and was well, and the device lacks what it needs now.
    NoLongerSupported,
}

impl Change {
    /// The word for people.
    pub fn word(self) -> &'static str {
        match self {
            Self::Regression => "regression",
            Self::Fixed => "fixed",
            Self::OtherFailure => "other failure",
            Self::NoLongerSupported => "no longer supported",
        }
    }

    /// Of a record that a baseline was applied to; none where nothing has changed or nothing is known.
    pub fn of(record: &Record) -> Option<Self> {
        use Verdict::{ExpectedFailure, NotSupported, Pass, QualityWarning};
        let was_run = |verdict| matches!(verdict, Pass | QualityWarning);
        match (record.baseline?, record.verdict) {
            (_, ExpectedFailure) => None,
            (then, now) if then.is_good() && !now.is_good() => Some(Self::Regression),
            (then, now) if !then.is_good() && !now.is_good() => Some(Self::OtherFailure),
            (then, now) if !then.is_good() && was_run(now) => Some(Self::Fixed),
            (then, NotSupported) if was_run(then) => Some(Self::NoLongerSupported),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::case::Profile;

    #[test]
    fn a_case_beside_an_earlier_run_is_the_same_or_has_changed() {
        use Verdict::{Crash, ExpectedFailure, Fail, NotSupported, Pass, QualityWarning, Waived};
        for (then, now, verdict, change) in [
            (Pass, Pass, Pass, None),
            (Pass, Fail, Fail, Some(Change::Regression)),
            (Waived, Fail, Fail, Some(Change::Regression)),
            (Fail, Fail, ExpectedFailure, None),
            (Fail, Crash, Crash, Some(Change::OtherFailure)),
            (Crash, QualityWarning, QualityWarning, Some(Change::Fixed)),
            (Fail, Waived, Waived, None),
            (
                Pass,
                NotSupported,
                NotSupported,
                Some(Change::NoLongerSupported),
            ),
            (NotSupported, Pass, Pass, None),
        ] {
            let baseline = Baseline([("a".to_owned(), then)].into());
            let mut record = Record::unmeasured("a", Profile::Full, now, String::new());
            baseline.apply(&mut record);
            assert_eq!(record.verdict, verdict, "{then} {now}");
            assert_eq!(Change::of(&record), change, "{then} {now}");
        }
        let mut new = Record::unmeasured("b", Profile::Full, Fail, String::new());
        Baseline::default().apply(&mut new);
        assert_eq!((new.verdict, Change::of(&new)), (Fail, None));
    }
}
