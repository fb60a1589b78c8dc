//! What is said of a case: the words of Khronos' own suites, `waived` and `expected_failure`.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The outcome of one case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Every number lies inside of its bound.
    Pass,
    /// Inside of what Vulkan allows, outside of what the device reports of itself or what a picture wants.
    QualityWarning,
    /// The device lacks what the case needs, by name, and an independent query says so too.
    NotSupported,
    /// A number lies outside of its bound.
    Fail,
    /// No memory.
    ResourceError,
    /// The suite or the library could not do its work: nothing is said of the device.
    InternalError,
    /// The process was still at work when its time was up.
    Timeout,
    /// The process ended by itself.
    Crash,
    /// The driver said that the device is lost.
    DeviceLost,
    /// Known: a waiver names it.
    Waived,
    /// It fails as it did in the baseline.
    ExpectedFailure,
}

impl Verdict {
    /// All of them, in the order of summaries.
    pub const ALL: [Self; 11] = [
        Self::Pass,
        Self::QualityWarning,
        Self::NotSupported,
        Self::Waived,
        Self::ExpectedFailure,
        Self::Fail,
        Self::ResourceError,
        Self::InternalError,
        Self::Timeout,
        Self::Crash,
        Self::DeviceLost,
    ];

    /// The word of records.
    pub fn word(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::QualityWarning => "quality_warning",
            Self::NotSupported => "not_supported",
            Self::Fail => "fail",
            Self::ResourceError => "resource_error",
            Self::InternalError => "internal_error",
            Self::Timeout => "timeout",
            Self::Crash => "crash",
            Self::DeviceLost => "device_lost",
            Self::Waived => "waived",
            Self::ExpectedFailure => "expected_failure",
        }
    }

    /// Whether a device may be called conformant with it.
    pub fn is_good(self) -> bool {
        matches!(
            self,
            Self::Pass | Self::QualityWarning | Self::NotSupported | Self::Waived
        )
    }

    /// Whether a run in which it occurs has failed: an expected failure is not good, and no news.
    pub fn fails_run(self) -> bool {
        !self.is_good() && self != Self::ExpectedFailure
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}
