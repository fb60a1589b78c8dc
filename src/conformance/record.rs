//! What is kept of a case and of a run. The layout is `SCHEMA`; its schema stands in `docs/conformance-schema.json`.

use super::case::Profile;
use super::measurement::{Bound, Worst};
use super::need::Found;
use super::verdict::Verdict;
use crate::gpu::Gpu;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// One case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// The case.
    pub name: String,
    /// What is said of it.
    pub verdict: Verdict,
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
    /// Numbers whose answer hangs on rounding.
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
    /// Verdicts of all runs, where there was more than one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub runs: Vec<Verdict>,
    /// What a waiver stands for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub waived: Option<Waived>,
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
            reason,
            profile,
            needs: Vec::new(),
            checked: 0,
            left_out: 0,
            found_sha256: String::new(),
            worst: None,
            bound: None,
            runs: Vec::new(),
            waived: None,
            unexpected_pass: false,
            pictures: Vec::new(),
            validation_messages: Vec::new(),
            ms: 0.0,
        }
    }
}

/// Which device was asked.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
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
    /// Limits that bounds and needs depend on, as the run had them.
    pub limits: BTreeMap<String, u64>,
}

impl DeviceRecord {
    /// Of a device in use.
    pub fn of(gpu: &Gpu) -> Self {
        let identity = gpu.identity();
        let limits = gpu.limits();
        let hex = |bytes: &[u8]| bytes.iter().map(|b| format!("{b:02x}")).collect();
        let [major, minor, patch] = identity.api_version;
        let [x, y, z] = limits.max_workgroup_count;
        let named: [(&str, u64); 10] = [
            ("subTexelPrecisionBits", limits.subtexel_bits.into()),
            ("maxImageDimension2D", limits.max_image_dimension_2d.into()),
            ("maxImageDimension3D", limits.max_image_dimension_3d.into()),
            ("maxImageArrayLayers", limits.max_image_array_layers.into()),
            (
                "maxStorageBufferRange",
                limits.max_storage_buffer_range.into(),
            ),
            (
                "maxComputeWorkGroupInvocations",
                limits.max_workgroup_invocations.into(),
            ),
            ("maxComputeWorkGroupCount[0]", x.into()),
            ("maxComputeWorkGroupCount[1]", y.into()),
            ("maxComputeWorkGroupCount[2]", z.into()),
            ("maxMemoryAllocationSize", limits.max_allocation_bytes),
        ];
        Self {
            name: identity.name.clone(),
            kind: identity.kind.name().to_owned(),
            driver: identity.driver_name.clone(),
            driver_id: identity.driver_id.as_raw() as u32,
            driver_info: identity.driver_info.clone(),
            driver_version: identity.driver_version,
            vulkan: format!("{major}.{minor}.{patch}"),
            vendor_id: identity.vendor_id,
            device_id: identity.device_id,
            uuid: hex(&identity.uuid),
            limits: named.map(|(name, n)| (name.to_owned(), n)).into(),
        }
    }
}

/// What was asked for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Asked {
    /// Which cases.
    pub profile: Profile,
    /// A pattern over their names.
    pub filter: String,
    /// Part I of N, from 1.
    pub shard: [u32; 2],
    /// What is random follows from it.
    pub seed: u64,
    /// Limits that were lowered: a word, or `device`.
    pub limits: String,
}

/// A whole run, as it lies in a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Package {
    /// [`super::SCHEMA`].
    pub stratavox_conformance: u32,
    /// The version of the suite.
    pub suite: String,
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
    /// Seconds of all of it.
    pub seconds: f64,
    /// In the order of the list.
    pub cases: Vec<Record>,
}
