//! A run as a package: made of records, and looked through as one that somebody handed in.

use super::SCHEMA;
use super::case::{Case, Profile};
use super::measurement::hex;
use super::record::{Asked, Build, DeviceRecord, Package, Record};
use super::selection::Selection;
use super::verdict::Verdict;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

impl Package {
    /// Of the records of what was asked for, in that order.
    pub fn new(
        list: &[Case],
        build: Build,
        asked: Asked,
        device: Option<DeviceRecord>,
        records: Vec<Record>,
        seconds: f64,
    ) -> Self {
        let is_partial = records.len() < asked.selection.of(list).len();
        let mut package = Self {
            stratavox_conformance: SCHEMA,
            suite: env!("CARGO_PKG_VERSION").to_owned(),
            build,
            list_sha256: list_sha256(list, asked.selection.profile),
            content_sha256: String::new(),
            asked,
            device,
            summary: summary_of(&records),
            is_partial,
            seconds,
            cases: records,
        };
        package.content_sha256 = package.content();
        package
    }

    /// SHA-256 of all but times and itself.
    fn content(&self) -> String {
        let mut timeless = self.clone();
        timeless.seconds = 0.0;
        timeless.content_sha256.clear();
        timeless.cases.iter_mut().for_each(|record| record.ms = 0.0);
        // Maps are in order, and numbers are written so that they are read back the same.
        let text = serde_json::to_vec(&timeless).unwrap_or_default();
        hex(&Sha256::digest(text))
    }

    /// Whether all cases are well.
    pub fn is_good(&self) -> bool {
        self.cases.iter().all(|record| record.verdict.is_good())
    }

    /// What is wrong with a package that claims to be a whole run of its profile; nothing where it is one and is good.
    pub fn complaints(&self, list: &[Case]) -> Vec<String> {
        let mut complaints = self.complaints_of_part(list);
        if self.asked.selection.is_part() {
            let asked = "a filter, a case list, an exclusion or a shard was asked for";
            complaints.push(format!("it is a part of the profile: {asked}"));
        }
        complaints
    }

    /// The same of one that claims to be what was asked for: a part of its profile is as good.
    pub fn complaints_of_part(&self, list: &[Case]) -> Vec<String> {
        let mut complaints = Vec::new();
        let mut complain = |text: String| complaints.push(text);
        if self.stratavox_conformance != SCHEMA {
            let found = self.stratavox_conformance;
            complain(format!("layout {found}, this program knows {SCHEMA}"));
        }
        if self.suite != env!("CARGO_PKG_VERSION") {
            let own = env!("CARGO_PKG_VERSION");
            complain(format!("made by suite {}, this is {own}", self.suite));
        }
        if self.list_sha256 != list_sha256(list, self.asked.selection.profile) {
            complain("its list of cases is not that of this suite".to_owned());
        }
        if self.content_sha256 != self.content() {
            complain("its content is not that of its hash: it was changed".to_owned());
        }
        if self.summary != summary_of(&self.cases) {
            complain("its summary does not count its cases".to_owned());
        }
        if self.device.is_none() {
            complain("it names no device".to_owned());
        }
        if self.asked.limits != "device" {
            complain(format!("limits were lowered: {}", self.asked.limits));
        }
        let [part, parts] = self.asked.selection.shard;
        if part == 0 || part > parts {
            complain(format!("part {part} of {parts}"));
            return complaints;
        }
        if self.is_partial {
            complain("the run ended before all of its cases had run".to_owned());
        }
        let wanted = self.asked.selection.of(list);
        let mut found: BTreeMap<&str, usize> = BTreeMap::new();
        for record in &self.cases {
            *found.entry(&record.name).or_default() += 1;
        }
        for case in &wanted {
            match found.remove(case.name.as_str()) {
                Some(1) => {}
                Some(n) => complain(format!("{} stands {n} times", case.name)),
                None if self.is_partial => {}
                None => complain(format!("{} is missing", case.name)),
            }
        }
        for name in found.keys() {
            complain(format!("{name} is no case of this list"));
        }
        for record in &self.cases {
            if !record.verdict.is_good() {
                complain(format!(
                    "{}: {}, {}",
                    record.name, record.verdict, record.reason
                ));
            }
            if record.command.is_empty() {
                complain(format!(
                    "{}: no command line that runs it again",
                    record.name
                ));
            }
            let named = record.needs.iter().any(|need| !need.library_has);
            if record.verdict == Verdict::NotSupported && !named {
                complain(format!(
                    "{}: not supported, and nothing named that lacks",
                    record.name
                ));
            }
        }
        complaints
    }
}

fn summary_of(records: &[Record]) -> BTreeMap<Verdict, usize> {
    let mut summary = BTreeMap::new();
    for record in records {
        *summary.entry(record.verdict).or_default() += 1;
    }
    summary
}

fn list_sha256(list: &[Case], profile: Profile) -> String {
    let mut hash = Sha256::new();
    for case in Selection::all(profile).of(list) {
        hash.update(case.name.as_bytes());
        hash.update(b"\n");
    }
    hex(&hash.finalize())
}
