//! What is known of a driver: a file of waivers, each for some cases on some drivers, with a reason and an end.
//!
//! ```text
//! { "stratavox_waivers": 1,
//!   "waivers": [ { "cases": "probe.*", "driver": "llvmpipe*", "from": "22.3.0", "before": "23.0.0",
//!                  "verdicts": ["fail"], "reason": "...", "link": "...", "expires": "2027-06-30" } ] }
//! ```
//!
//! `driver` is a pattern over the driver's name, `from` (included) and `before` (excluded) are versions: the first
//! numbers with dots of what the driver says of itself. Left out, they are not asked for.

use super::glob::matches;
use super::record::{DeviceRecord, Record, Waived};
use super::verdict::Verdict;
use serde::{Deserialize, Serialize};
use std::time::{SystemTime, UNIX_EPOCH};

/// A file of waivers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Waivers {
    stratavox_waivers: u32,
    waivers: Vec<Waiver>,
}

/// One thing that is known.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Waiver {
    cases: String,
    driver: String,
    #[serde(default)]
    from: Option<String>,
    #[serde(default)]
    before: Option<String>,
    verdicts: Vec<Verdict>,
    reason: String,
    link: String,
    expires: String,
}

impl Waivers {
    /// Reads the text of a file.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn read(text: &str) -> Result<Self, String> {
        let read: Self = serde_json::from_str(text).map_err(|error| error.to_string())?;
        if read.stratavox_waivers != 1 {
            let found = read.stratavox_waivers;
            return Err(format!("stratavox_waivers: wanted 1, found {found}"));
        }
        for (nth, waiver) in read.waivers.iter().enumerate() {
            let wrong = |field, wanted, found: &str| {
                Err(format!(
                    "waiver {nth}, {field}: wanted {wanted}, found {found:?}"
                ))
            };
            if day(&waiver.expires).is_none() {
                return wrong("expires", "a day as 2027-06-30", &waiver.expires);
            }
            if waiver.reason.is_empty() {
                return wrong("reason", "a reason", "");
            }
            for end in [&waiver.from, &waiver.before].into_iter().flatten() {
                if version(end).is_empty() {
                    return wrong("from, before", "a version as 22.3.6", end);
                }
            }
            if let Some(good) = waiver
                .verdicts
                .iter()
                .find(|v| matches!(v, Verdict::Pass | Verdict::Waived))
            {
                return wrong("verdicts", "what can be waived", good.word());
            }
        }
        Ok(read)
    }

    /// Waives what is known of `record`, and marks what is known and did not come.
    pub fn apply(&self, record: &mut Record, device: &DeviceRecord, today: [u32; 3]) {
        let mut meant = self.waivers.iter().filter(|waiver| {
            matches(&waiver.cases, &record.name)
                && waiver.is_of(device)
                && day(&waiver.expires).is_some_and(|end| today <= end)
        });
        if record.verdict == Verdict::Pass {
            record.unexpected_pass = meant.next().is_some();
            return;
        }
        if let Some(waiver) = meant.find(|waiver| waiver.verdicts.contains(&record.verdict)) {
            record.waived = Some(Waived {
                verdict: record.verdict,
                reason: waiver.reason.clone(),
                link: waiver.link.clone(),
            });
            record.verdict = Verdict::Waived;
        }
    }
}

impl Waiver {
    fn is_of(&self, device: &DeviceRecord) -> bool {
        let found = version(&device.driver_info);
        matches(&self.driver, &device.driver)
            && self.from.as_ref().is_none_or(|from| version(from) <= found)
            && self
                .before
                .as_ref()
                .is_none_or(|before| found < version(before))
    }
}

/// The first numbers with dots between: `Mesa 22.3.6 (LLVM 15.0.6)` is 22, 3, 6.
fn version(text: &str) -> Vec<u32> {
    let first = text.split(|c: char| !c.is_ascii_digit() && c != '.');
    let first = first
        .into_iter()
        .find(|part| part.starts_with(|c: char| c.is_ascii_digit()));
    first
        .unwrap_or_default()
        .split('.')
        .filter_map(|n| n.parse().ok())
        .collect()
}

fn day(text: &str) -> Option<[u32; 3]> {
    let numbers: Vec<u32> = text
        .split('-')
        .map(|n| n.parse().ok())
        .collect::<Option<_>>()?;
    let day: [u32; 3] = numbers.try_into().ok()?;
    ((1..=12).contains(&day[1]) && (1..=31).contains(&day[2])).then_some(day)
}

/// Year, month and day of now, UTC (Hinnant, "chrono-compatible low-level date algorithms": civil_from_days).
pub fn today() -> [u32; 3] {
    let seconds = SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .map_or(0, |d| d.as_secs());
    let z = seconds / 86_400 + 719_468;
    let (era, of_era) = (z / 146_097, z % 146_097);
    let year = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let shifted = (5 * of_year + 2) / 153;
    let day = of_year - (153 * shifted + 2) / 5 + 1;
    let month = if shifted < 10 {
        shifted + 3
    } else {
        shifted - 9
    };
    let year = year + era * 400 + u64::from(month <= 2);
    [year as u32, month as u32, day as u32]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::case::Profile;

    fn device(driver: &str, info: &str) -> DeviceRecord {
        DeviceRecord {
            name: String::new(),
            kind: "cpu".into(),
            driver: driver.into(),
            driver_info: info.into(),
            driver_version: 0,
            vulkan: String::new(),
            vendor_id: 0,
            device_id: 0,
            uuid: String::new(),
            ..DeviceRecord::default()
        }
    }

    const FILE: &str = r#"{"stratavox_waivers": 1, "waivers": [{"cases": "probe.*", "driver": "llvm*",
        "from": "22.3", "before": "23", "verdicts": ["fail"], "reason": "known", "link": "", "expires": "2027-06-30"}]}"#;

    #[test]
    fn a_waiver_is_for_its_cases_its_drivers_its_verdicts_and_its_time() {
        let waivers = Waivers::read(FILE).unwrap();
        let mesa = "Mesa 22.3.6 (LLVM 15.0.6)";
        for (name, verdict, driver, info, day, wanted) in [
            (
                "probe.a",
                Verdict::Fail,
                "llvmpipe",
                mesa,
                [2027, 6, 30],
                Verdict::Waived,
            ),
            (
                "probe.a",
                Verdict::Fail,
                "llvmpipe",
                mesa,
                [2027, 7, 1],
                Verdict::Fail,
            ),
            (
                "probe.a",
                Verdict::Crash,
                "llvmpipe",
                mesa,
                [2026, 1, 1],
                Verdict::Crash,
            ),
            (
                "twin.a",
                Verdict::Fail,
                "llvmpipe",
                mesa,
                [2026, 1, 1],
                Verdict::Fail,
            ),
            (
                "probe.a",
                Verdict::Fail,
                "radv",
                mesa,
                [2026, 1, 1],
                Verdict::Fail,
            ),
            (
                "probe.a",
                Verdict::Fail,
                "llvmpipe",
                "Mesa 23.0.0",
                [2026, 1, 1],
                Verdict::Fail,
            ),
            (
                "probe.a",
                Verdict::Fail,
                "llvmpipe",
                "Mesa 22.2.9",
                [2026, 1, 1],
                Verdict::Fail,
            ),
        ] {
            let mut record = Record::unmeasured(name, Profile::Full, verdict, String::new());
            waivers.apply(&mut record, &device(driver, info), day);
            assert_eq!(record.verdict, wanted, "{name} {driver} {info} {day:?}");
        }
        let mut record = Record::unmeasured("probe.a", Profile::Full, Verdict::Pass, String::new());
        waivers.apply(&mut record, &device("llvmpipe", mesa), [2026, 1, 1]);
        assert!(record.unexpected_pass);
    }

    #[test]
    fn what_is_wrong_with_a_file_is_named() {
        for (from, to, named) in [
            ("2027-06-30", "soon", "expires"),
            ("\"known\"", "\"\"", "reason"),
            ("\"22.3\"", "\"new\"", "from"),
            ("[\"fail\"]", "[\"pass\"]", "verdicts"),
            (
                "stratavox_waivers\": 1",
                "stratavox_waivers\": 2",
                "stratavox_waivers",
            ),
            ("\"link\"", "\"url\"", "url"),
        ] {
            let error = Waivers::read(&FILE.replace(from, to)).unwrap_err();
            assert!(error.contains(named), "{error}");
        }
    }
}
