//! How far numbers are from where they should be, against what each is allowed.
//!
//! ```text
//! ratio = |found - expected| / allowed          margin = 1 - ratio, of the worst number
//! ```
//!
//! A second, stricter allowance may be given: outside of it, and inside of the first, is a quality warning.

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

/// Where a bound comes from.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Bound {
    /// The name of the derivation.
    pub id: String,
    /// The derivation.
    pub derivation: String,
    /// The numbers that went into it.
    pub inputs: BTreeMap<String, f64>,
}

impl Bound {
    /// A bound without inputs.
    pub fn new(id: &str, derivation: impl Into<String>) -> Self {
        Self {
            id: id.to_owned(),
            derivation: derivation.into(),
            inputs: BTreeMap::new(),
        }
    }

    /// The same with one number more.
    pub fn with(mut self, name: &str, number: f64) -> Self {
        self.inputs.insert(name.to_owned(), number);
        self
    }
}

/// One number, where it is and what it is allowed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// Which number: a pixel, a channel, an index.
    pub at: String,
    /// What it should be; as all of these, a word where it is no number that JSON has.
    #[serde(with = "any_float")]
    pub expected: f64,
    /// What it is.
    #[serde(with = "any_float")]
    pub found: f64,
    /// How far apart the two may be.
    #[serde(with = "any_float")]
    pub allowed: f64,
    /// How far they are, in parts of that.
    #[serde(with = "any_float")]
    pub ratio: f64,
}

/// What a picture should be and what it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Pictures {
    /// Pixels across.
    pub width: u32,
    /// Premultiplied colour, rows from the top.
    pub expected: Vec<[f32; 4]>,
    /// The same, as found.
    pub found: Vec<[f32; 4]>,
}

/// All that was measured of one case.
#[derive(Clone, Debug)]
pub struct Measurement {
    /// Where the allowances come from.
    pub bound: Bound,
    /// Numbers that were looked at.
    pub checked: usize,
    /// Numbers whose answer depends on rounding, and were not.
    pub left_out: usize,
    /// A case that looks at fewer says nothing.
    pub least: usize,
    /// The number that is farthest out.
    pub worst: Worst,
    /// The same against the stricter allowance, and what lying outside of it means.
    pub quality: Option<(Worst, &'static str)>,
    /// For the report of a failure.
    pub pictures: Option<Pictures>,
    /// Over all numbers that were found.
    found: Sha256,
}

impl Measurement {
    /// Of at least `least` numbers.
    pub fn new(bound: Bound, least: usize) -> Self {
        Self {
            bound,
            checked: 0,
            left_out: 0,
            least,
            worst: Worst::default(),
            quality: None,
            pictures: None,
            found: Sha256::new(),
        }
    }

    /// One number. What is not a number is infinitely wrong, but where that is expected.
    pub fn take(&mut self, at: impl FnOnce() -> String, expected: f64, found: f64, allowed: f64) {
        self.checked += 1;
        self.found.update(found.to_le_bytes());
        let ratio = ratio_of(expected, found, allowed);
        if ratio > self.worst.ratio {
            self.worst = Worst {
                at: at(),
                expected,
                found,
                allowed,
                ratio,
            };
        }
    }

    /// One number that may be anything from `low` to `high`, both allowed `slack` more.
    pub fn take_in(
        &mut self,
        at: impl FnOnce() -> String,
        [low, high]: [f64; 2],
        found: f64,
        slack: f64,
    ) {
        self.take(at, 0.5 * (low + high), found, 0.5 * (high - low) + slack);
    }

    /// The same number against what it should better be. `meaning` says what it means where it is not.
    pub fn prefer(
        &mut self,
        meaning: &'static str,
        at: impl FnOnce() -> String,
        expected: f64,
        found: f64,
        allowed: f64,
    ) {
        let ratio = ratio_of(expected, found, allowed);
        let known = self.quality.as_ref().map_or(-1.0, |(worst, _)| worst.ratio);
        if ratio > known {
            let worst = Worst {
                at: at(),
                expected,
                found,
                allowed,
                ratio,
            };
            self.quality = Some((worst, meaning));
        }
    }

    /// SHA-256 of all numbers that were found, in their order: two runs with the same one have found the same, bit for
    /// bit. Empty where there were none.
    pub fn found_sha256(&self) -> String {
        match self.checked {
            0 => String::new(),
            _ => hex(&self.found.clone().finalize()),
        }
    }

    /// So many numbers whose answers depend on rounding.
    pub fn leave_out(&mut self, numbers: usize) {
        self.left_out += numbers;
    }

    /// One fact that holds or does not.
    pub fn hold(&mut self, at: impl FnOnce() -> String, holds: bool) {
        self.take(at, 1.0, f64::from(u8::from(holds)), 0.5);
    }
}

/// As hashes stand in records.
pub(crate) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn ratio_of(expected: f64, found: f64, allowed: f64) -> f64 {
    if expected == found || (expected.is_nan() && found.is_nan()) {
        return 0.0;
    }
    let error = (found - expected).abs();
    if error.is_nan() || allowed.is_nan() {
        return f64::INFINITY;
    }
    // Of an allowance of nothing, everything is infinitely much.
    error / allowed
}

/// Numbers as JSON has them, and words for the others.
mod any_float {
    use serde::{Deserialize, Deserializer, Serializer};

    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Any {
        Number(f64),
        Word(String),
    }

    pub fn serialize<S: Serializer>(number: &f64, to: S) -> Result<S::Ok, S::Error> {
        match number.is_finite() {
            true => to.serialize_f64(*number),
            false => to.serialize_str(&number.to_string()),
        }
    }

    pub fn deserialize<'d, D: Deserializer<'d>>(from: D) -> Result<f64, D::Error> {
        match Any::deserialize(from)? {
            Any::Number(number) => Ok(number),
            Any::Word(word) => word.parse().map_err(serde::de::Error::custom),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_a_number_is_infinitely_wrong_and_stays_the_worst() {
        let mut found = Measurement::new(Bound::default(), 1);
        found.take(|| "a".into(), 1.0, f64::NAN, 1.0);
        found.take(|| "b".into(), 1.0, 1.5, 1.0);
        assert_eq!(found.worst.at, "a");
        assert_eq!(found.worst.ratio, f64::INFINITY);
        let text = serde_json::to_string(&found.worst).unwrap();
        let read: Worst = serde_json::from_str(&text).unwrap();
        assert!(read.found.is_nan() && read.ratio == f64::INFINITY, "{text}");
        let mut found = Measurement::new(Bound::default(), 1);
        found.take(|| "nothing is there".into(), f64::NAN, f64::NAN, 0.0);
        assert_eq!(found.worst.ratio, 0.0);
        found.take(|| "something is there".into(), f64::NAN, 1.0, 0.0);
        let text = serde_json::to_string(&found.worst).unwrap();
        let read: Worst = serde_json::from_str(&text).unwrap();
        assert!(
            read.expected.is_nan() && read.ratio == f64::INFINITY,
            "{text}"
        );
    }

    #[test]
    fn nothing_allowed_is_exact() {
        let mut found = Measurement::new(Bound::default(), 1);
        found.take(|| "a".into(), 1.0, 1.0, 0.0);
        assert_eq!(found.worst.ratio, 0.0);
        found.take(|| "a".into(), 1.0, 1.0 + f64::EPSILON, 0.0);
        assert_eq!(found.worst.ratio, f64::INFINITY);
    }
}
