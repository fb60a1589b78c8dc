//! Two packages side by side: two drivers, or two runs on one.

use super::record::{Package, Record};
use std::collections::BTreeMap;
use std::fmt::Write;

/// A case whose worst number lies by so many times more of its allowance off is told.
const TOLD_RATIO: f64 = 1.25;
/// Of less nobody wants to hear.
const LEAST_RATIO: f64 = 0.01;

/// How two packages differ.
#[derive(Debug, Default)]
pub struct Difference {
    /// Cases with two verdicts, a line each.
    pub verdicts: Vec<String>,
    /// Cases that stand in one of them alone.
    pub alone: Vec<String>,
    /// Cases whose worst numbers are further in the one than in the other.
    pub margins: Vec<String>,
    /// Cases that are the same but for times.
    pub same: usize,
    /// All that stand in both, by the first word of their names, and of probes by two.
    pub branches: BTreeMap<String, Branch>,
}

/// The cases of a branch of the tree, as two packages have them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Branch {
    /// How many.
    pub cases: usize,
    /// Of how many every number that was found is the same, bit for bit.
    pub same_numbers: usize,
    /// The largest part of what is allowed that a number of A and of B takes, where both have the same verdict: a
    /// warning measures by what is stricter.
    pub worst: [f64; 2],
}

impl Difference {
    /// Of A and B.
    pub fn of(a: &Package, b: &Package) -> Self {
        let mut difference = Self::default();
        let mut others: BTreeMap<&str, &Record> = b
            .cases
            .iter()
            .map(|record| (record.name.as_str(), record))
            .collect();
        for one in &a.cases {
            match others.remove(one.name.as_str()) {
                None => difference.alone.push(format!("{}: in A alone", one.name)),
                Some(other) => difference.compare(one, other),
            }
        }
        let alone = others.keys().map(|name| format!("{name}: in B alone"));
        difference.alone.extend(alone);
        difference
    }

    fn compare(&mut self, a: &Record, b: &Record) {
        let ratio = |record: &Record| record.worst.as_ref().map_or(0.0, |worst| worst.ratio);
        let (of_a, of_b) = (ratio(a), ratio(b));
        let branch = self.branches.entry(branch_of(&a.name)).or_default();
        branch.cases += 1;
        let is_known = !a.found_sha256.is_empty();
        branch.same_numbers += usize::from(is_known && a.found_sha256 == b.found_sha256);
        if a.verdict != b.verdict {
            let line = format!("{}: {} in A, {} in B", a.name, a.verdict, b.verdict);
            self.verdicts.push(line);
            return;
        }
        branch.worst = [branch.worst[0].max(of_a), branch.worst[1].max(of_b)];
        let timeless = |record: &Record| Record {
            ms: 0.0,
            ..record.clone()
        };
        let (low, high) = (of_a.min(of_b), of_a.max(of_b));
        if high > LEAST_RATIO && high > TOLD_RATIO * low {
            let line = format!(
                "{}: {of_a:.3} of what is allowed in A, {of_b:.3} in B",
                a.name
            );
            self.margins.push(line);
        }
        self.same += usize::from(timeless(a) == timeless(b));
    }

    /// Whether both say the same of every case.
    pub fn agrees(&self) -> bool {
        self.verdicts.is_empty() && self.alone.is_empty()
    }

    /// For a person.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for (title, lines) in [
            ("other verdicts", &self.verdicts),
            ("in one alone", &self.alone),
            ("other margins", &self.margins),
        ] {
            let _ = writeln!(text, "{title}: {}", lines.len());
            for line in lines {
                let _ = writeln!(text, "  {line}");
            }
        }
        let _ = writeln!(text, "the same but for times: {}", self.same);
        text.push_str("\n| Cases | in both | the same numbers | worst of A | worst of B |\n|---|---|---|---|---|\n");
        for (name, branch) in &self.branches {
            let [a, b] = branch.worst;
            let Branch {
                cases,
                same_numbers,
                ..
            } = branch;
            let _ = writeln!(
                text,
                "| `{name}` | {cases} | {same_numbers} | {a:.3} | {b:.3} |"
            );
        }
        text
    }
}

fn branch_of(name: &str) -> String {
    let words = match name.starts_with("probe.") {
        true => 2,
        false => 1,
    };
    let words: Vec<&str> = name.split('.').take(words).collect();
    words.join(".")
}
