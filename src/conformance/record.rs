//! What is kept of a case and of a run. The layout is `SCHEMA`; its schema stands in `docs/conformance-schema.json`.

use super::case::Profile;
use super::measurement::{Bound, Worst};
use super::need::Found;
use super::selection::Selection;
use super::verdict::Verdict;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// One case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// The case.
    pub name: String,
    /// What is said of it.
    pub verdict: Verdict,
    /// The command line that runs it again.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub command: String,
    /// Why, where that is not `pass`.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub reason: String,
    /// Which devices must pass it.
    pub profile: Profile,
    /// What it asks of a device, and what the device has.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub needs: Vec<Found>,
    /// Numbers that were compared.
    pub checked: usize,
    /// Numbers whose answer depends on rounding.
    pub left_out: usize,
    /// SHA-256 of what was found in their place, as f64, the lowest byte first.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub found_sha256: String,
    /// The number that is farthest out, as far as any is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub worst: Option<Worst>,
    /// Where the allowances come from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bound: Option<Bound>,
    /// More than a tenth of the channels of its picture may be off by more than half a code of 255: that it passes
    /// proves little.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub weak_bound: bool,
    /// Verdicts of all runs, where they were not the same.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub runs: Vec<Verdict>,
    /// What a waiver stands for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub waived: Option<Waived>,
    /// Its verdict in the baseline, where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub baseline: Option<Verdict>,
    /// A waiver names it, and it passed.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub unexpected_pass: bool,
    /// Files of expected, found and difference beside the page.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pictures: Vec<String>,
    /// What the driver's layer said.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub validation_messages: Vec<String>,
    /// How long it took: the one thing that may differ between two runs.
    pub ms: f64,
}

/// A verdict that is known.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Waived {
    /// The verdict.
    pub verdict: Verdict,
    /// Why it is known.
    pub reason: String,
    /// Where it is written about.
    pub link: String,
}

impl Record {
    /// One that nothing was measured of.
    pub fn unmeasured(name: &str, profile: Profile, verdict: Verdict, reason: String) -> Self {
        Self {
            name: name.to_owned(),
            verdict,
            command: String::new(),
            reason,
            profile,
            needs: Vec::new(),
            checked: 0,
            left_out: 0,
            found_sha256: String::new(),
            worst: None,
            bound: None,
            weak_bound: false,
            runs: Vec::new(),
            waived: None,
            baseline: None,
            unexpected_pass: false,
            pictures: Vec::new(),
            validation_messages: Vec::new(),
            ms: 0.0,
        }
    }
}

/// Which device was asked.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct DeviceRecord {
    /// The device's name.
    pub name: String,
    /// Discrete, integrated, ...
    pub kind: String,
    /// The driver's name.
    pub driver: String,
    /// The number of its `VkDriverId`.
    pub driver_id: u32,
    /// The driver's version in its own words.
    pub driver_info: String,
    /// The driver's version as a number.
    pub driver_version: u32,
    /// `1.3.230`.
    pub vulkan: String,
    /// PCI vendor, or a Khronos number.
    pub vendor_id: u32,
    /// The vendor's number for the device.
    pub device_id: u32,
    /// Names the device.
    pub uuid: String,
    /// Limits that bounds, needs and the library depend on, as the run had them.
    pub limits: BTreeMap<String, u64>,
    /// Features that the library asks for, and whether they are enabled.
    pub features: BTreeMap<String, bool>,
    /// Extensions of the device that are enabled.
    pub extensions_enabled: Vec<String>,
    /// Extensions that the device has.
    pub extensions_available: Vec<String>,
}

/// What was asked for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Asked {
    /// Which cases, in which order.
    #[serde(flatten)]
    pub selection: Selection,
    /// What is random follows from it.
    pub seed: u64,
    /// Limits that were lowered: a word, or `device`.
    pub limits: String,
    /// How often each case ran.
    pub repeat: u32,
    /// Whether cases ran in the process of the supervisor.
    pub in_process: bool,
    /// On how many queues and threads they ran at once, after each had run alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stress: Option<Stress>,
}

/// Threads that run cases at once on one device.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stress {
    /// Queues that they share: as many as the device has of those that were asked for.
    pub queues: u32,
    /// How many there are.
    pub threads: u32,
}

/// What the program was built from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Build {
    /// The commit, with `-dirty` behind it where files were changed since; `unknown` where the build was not told.
    pub commit: String,
    /// SHA-256 of the `Cargo.lock` beside the source.
    pub cargo_lock_sha256: String,
}

/// A whole run, as it lies in a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Package {
    /// [`super::SCHEMA`].
    pub stratavox_conformance: u32,
    /// The version of the suite.
    pub suite: String,
    /// What the suite was built from.
    pub build: Build,
    /// SHA-256 of the names of all cases of the profile: which list this is a run of.
    pub list_sha256: String,
    /// SHA-256 of all that stands here, but for times and for this.
    pub content_sha256: String,
    /// What was asked for.
    pub asked: Asked,
    /// The device; none where none could be asked.
    pub device: Option<DeviceRecord>,
    /// How many cases have which verdict.
    pub summary: BTreeMap<Verdict, usize>,
    /// The run ended before all cases had run that were asked for.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_partial: bool,
    /// Seconds of all of it.
    pub seconds: f64,
    /// In the order in which they were asked for.
    pub cases: Vec<Record>,
}
