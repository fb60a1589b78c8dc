//! What is known of drivers: a file of waivers, each for some cases on some drivers, with a reason, a link and an end.
//!
//! ```text
//! { "stratavox_waivers": 1,
//!   "waivers": [ { "cases": "probe.*", "vendor_id": "0x1ae0", "driver": "SwiftShader driver",
//!                  "driver_version": { "from": "5.0.0", "before": 20971521 },
//!                  "verdicts": ["fail"], "reason": "...", "link": "https://...", "expires": "2027-06-30" } ] }
//! ```
//!
//! `docs/conformance.md` has the fields.

mod version;

use super::glob::matches;
use super::record::{DeviceRecord, Record, Waived};
use super::verdict::Verdict;
use serde::Deserialize;
use serde_json::Value;
use std::time::{SystemTime, UNIX_EPOCH};
use version::{Version, number};

/// What is known, of any number of files.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Waivers(Vec<Waiver>);

/// One thing that is known. What is `None` may be anything.
#[derive(Clone, Debug, PartialEq)]
struct Waiver {
    cases: String,
    vendor_id: Option<u32>,
    device_id: Option<u32>,
    driver_id: Option<u32>,
    driver: Option<String>,
    driver_info: Option<String>,
    from: Option<Version>,
    before: Option<Version>,
    verdicts: Vec<Verdict>,
    reason: String,
    link: String,
    expires: [u32; 3],
}

/// A file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    stratavox_waivers: u32,
    waivers: Vec<Written>,
}

/// A waiver as a file has it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    cases: String,
    vendor_id: Option<Value>,
    device_id: Option<Value>,
    driver_id: Option<Value>,
    driver: Option<String>,
    driver_info: Option<String>,
    driver_version: Option<Range>,
    verdicts: Vec<Verdict>,
    #[serde(default)]
    reason: String,
    #[serde(default)]
    link: String,
    expires: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Range {
    from: Option<Value>,
    before: Option<Value>,
}

impl Waivers {
    /// Adds those of the text of a file.
    ///
    /// # Errors
    /// What is wrong with it: the waiver, counted from 1, the field, what is wanted there and what was found.
    pub fn read(&mut self, text: &str) -> Result<(), String> {
        let file: File = serde_json::from_str(text).map_err(|error| error.to_string())?;
        if file.stratavox_waivers != 1 {
            let found = file.stratavox_waivers;
            return Err(format!("stratavox_waivers: wanted 1, found {found}"));
        }
        for (number, written) in (1..).zip(file.waivers) {
            let checked = written.checked();
            self.0
                .push(checked.map_err(|wrong| format!("waiver {number}, {wrong}"))?);
        }
        Ok(())
    }

    /// Waives what is known of `record`, and marks what is known and did not come.
    pub fn apply(&self, record: &mut Record, device: &DeviceRecord, today: [u32; 3]) {
        let mut meant = self.0.iter().filter(|waiver| {
            matches(&waiver.cases, &record.name) && waiver.is_of(device) && today <= waiver.expires
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

impl Written {
    /// With every field looked at, or the first one that is wrong.
    fn checked(self) -> Result<Waiver, String> {
        let wrong = |field: &str, wanted: &str, found: &dyn std::fmt::Debug| {
            format!("{field}: wanted {wanted}, found {found:?}")
        };
        for (field, text) in [("reason", &self.reason), ("link", &self.link)] {
            if text.trim().is_empty() {
                return Err(wrong(field, "a text", text));
            }
        }
        let Some(expires) = day(&self.expires) else {
            return Err(wrong("expires", "a day as 2027-06-30", &self.expires));
        };
        let is_good = |verdict: &&Verdict| matches!(verdict, Verdict::Pass | Verdict::Waived);
        if let Some(good) = self.verdicts.iter().find(is_good) {
            return Err(wrong("verdicts", "what can be waived", &good.word()));
        }
        let id = |field: &str, value: &Option<Value>| match value {
            None => Ok(None),
            Some(value) => match number(value) {
                Some(number) => Ok(Some(number)),
                None => Err(wrong(field, "a number or a text as \"0x1ae0\"", value)),
            },
        };
        let [vendor_id, device_id, driver_id] = [
            id("vendor_id", &self.vendor_id)?,
            id("device_id", &self.device_id)?,
            id("driver_id", &self.driver_id)?,
        ];
        if vendor_id.is_none() && driver_id.is_none() && self.driver.is_none() {
            let wanted = "vendor_id, driver_id or driver";
            return Err(wrong("driver", wanted, &"none of them"));
        }
        let bound = |field: &str, value: Option<Value>| match value {
            None => Ok(None),
            Some(value) => match Version::of(&value) {
                Some(version) => Ok(Some(version)),
                None => Err(wrong(field, "a number, or a version as \"22.3.6\"", &value)),
            },
        };
        let range = self.driver_version;
        let [from, before] = range.map_or([None, None], |range| [range.from, range.before]);
        let from = bound("driver_version, from", from)?;
        let before = bound("driver_version, before", before)?;
        let is_empty = match (from, before) {
            (Some(Version::Packed(from)), Some(Version::Packed(before))) => before <= from,
            (Some(Version::Parts(from)), Some(Version::Parts(before))) => before <= from,
            _ => false,
        };
        if is_empty {
            return Err(wrong(
                "driver_version",
                "from below before",
                &[from, before],
            ));
        }
        Ok(Waiver {
            cases: self.cases,
            vendor_id,
            device_id,
            driver_id,
            driver: self.driver,
            driver_info: self.driver_info,
            from,
            before,
            verdicts: self.verdicts,
            reason: self.reason,
            link: self.link,
            expires,
        })
    }
}

impl Waiver {
    fn is_of(&self, device: &DeviceRecord) -> bool {
        let is_id = |wanted: Option<u32>, found: u32| wanted.is_none_or(|wanted| wanted == found);
        let is_text = |pattern: &Option<String>, found: &str| {
            let pattern = pattern.as_ref();
            pattern.is_none_or(|pattern| matches(pattern, found))
        };
        is_id(self.vendor_id, device.vendor_id)
            && is_id(self.device_id, device.device_id)
            && is_id(self.driver_id, device.driver_id)
            && is_text(&self.driver, &device.driver)
            && is_text(&self.driver_info, &device.driver_info)
            && self.from.is_none_or(|from| !from.is_after(device))
            && self.before.is_none_or(|before| before.is_after(device))
    }
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
    use serde_json::json;

    fn swiftshader() -> DeviceRecord {
        DeviceRecord {
            name: "SwiftShader Device (Subzero)".into(),
            kind: "cpu".into(),
            driver: "SwiftShader driver".into(),
            driver_id: 10,
            driver_info: String::new(),
            driver_version: 20_971_520,
            vulkan: String::new(),
            vendor_id: 0x1ae0,
            device_id: 0xc0de,
            uuid: String::new(),
            ..DeviceRecord::default()
        }
    }

    fn file() -> Value {
        json!({"stratavox_waivers": 1, "waivers": [{
            "cases": "probe.*", "vendor_id": "0x1ae0", "device_id": 49374, "driver_id": 10, "driver": "Swift*",
            "driver_info": "", "driver_version": {"from": "5.0", "before": 20_971_521}, "verdicts": ["fail"],
            "reason": "known", "link": "https://example.org/1", "expires": "2027-06-30"}]})
    }

    fn read(file: &Value) -> Result<Waivers, String> {
        let mut waivers = Waivers::default();
        waivers.read(&file.to_string()).map(|()| waivers)
    }

    #[test]
    fn a_waiver_is_for_its_cases_its_drivers_its_verdicts_and_its_time() {
        let waivers = read(&file()).unwrap();
        let (probe, last_day) = ("probe.a", [2027, 6, 30]);
        let verdict_of = |name, verdict, device: &DeviceRecord, day| {
            let mut record = Record::unmeasured(name, Profile::Full, verdict, String::new());
            waivers.apply(&mut record, device, day);
            record.verdict
        };
        let fails = |device| verdict_of(probe, Verdict::Fail, &device, last_day);
        let other = |change: fn(&mut DeviceRecord)| {
            let mut device = swiftshader();
            change(&mut device);
            device
        };
        assert_eq!(fails(swiftshader()), Verdict::Waived);
        for device in [
            other(|device| device.vendor_id = 0x10de),
            other(|device| device.device_id += 1),
            other(|device| device.driver_id = 4),
            other(|device| device.driver = "llvmpipe".into()),
            other(|device| device.driver_info = "Mesa 22.3.6".into()),
            other(|device| device.driver_version -= 1),
            other(|device| device.driver_version += 1),
        ] {
            assert_eq!(fails(device.clone()), Verdict::Fail, "{device:?}");
        }
        let same = swiftshader();
        let crash = verdict_of(probe, Verdict::Crash, &same, last_day);
        assert_eq!(crash, Verdict::Crash);
        let late = verdict_of(probe, Verdict::Fail, &same, [2027, 7, 1]);
        assert_eq!(late, Verdict::Fail);
        let other_case = verdict_of("reference.a", Verdict::Fail, &same, last_day);
        assert_eq!(other_case, Verdict::Fail);
        let mut record = Record::unmeasured(probe, Profile::Full, Verdict::Pass, String::new());
        waivers.apply(&mut record, &same, last_day);
        assert!(record.unexpected_pass);
    }

    #[test]
    fn what_is_wrong_with_a_file_is_named() {
        for (field, value, named) in [
            ("expires", json!("soon"), "expires: wanted a day"),
            ("reason", json!(""), "reason: wanted a text"),
            (
                "link",
                json!(" "),
                "waiver 1, link: wanted a text, found \" \"",
            ),
            ("vendor_id", json!("1ae0"), "vendor_id: wanted a number"),
            ("device_id", json!(-1), "device_id: wanted a number"),
            ("driver_id", json!(1u64 << 32), "driver_id: wanted a number"),
            (
                "driver_version",
                json!({"from": "new"}),
                "driver_version, from: wanted a number",
            ),
            (
                "driver_version",
                json!({"before": "1.2.3.4.5"}),
                "driver_version, before: wanted a number",
            ),
            (
                "driver_version",
                json!({"from": "5.1", "before": "5.0.9"}),
                "driver_version: wanted from below before",
            ),
            ("verdicts", json!(["pass"]), "verdicts"),
            ("url", json!(""), "url"),
        ] {
            let mut file = file();
            file["waivers"][0][field] = value;
            let error = read(&file).unwrap_err();
            assert!(error.contains(named), "{field}: {error}");
        }
        let mut without = file();
        without["waivers"][0]
            .as_object_mut()
            .unwrap()
            .remove("link");
        let error = read(&without).unwrap_err();
        assert!(error.contains("link: wanted a text"), "{error}");
        let error = read(&json!({"stratavox_waivers": 2, "waivers": []})).unwrap_err();
        assert!(error.contains("stratavox_waivers: wanted 1"), "{error}");
        let anyone = json!({"stratavox_waivers": 1, "waivers": [{"cases": "*", "verdicts": ["fail"],
            "reason": "known", "link": "https://example.org/1", "expires": "2027-06-30"}]});
        let error = read(&anyone).unwrap_err();
        assert!(error.contains("vendor_id, driver_id or driver"), "{error}");
    }
}
