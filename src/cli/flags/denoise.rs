//! The words of `--denoise`: `gaussian[:SIGMA]`, `median`, `bilateral[:SIGMA[:VALUE]]`, `nlm[:VALUE]`.

use super::positive;
use crate::volume::{Denoise, MAX_SIGMA_VOXELS};
use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

/// A noise filter, as it is written.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct DenoiseWord(pub Denoise);

/// Where no deviation is given.
const SIGMA_VOXELS: f64 = 1.0;

impl FromStr for DenoiseWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wanted = || {
            "wanted gaussian[:SIGMA], median, bilateral[:SIGMA[:VALUE]] or nlm[:VALUE]".to_owned()
        };
        let mut words = text.split(':');
        let kind = words.next();
        let numbers: Vec<f64> = words.map(positive).collect::<Result<_, _>>()?;
        let sigma_voxels = numbers.first().copied().unwrap_or(SIGMA_VOXELS);
        if kind != Some("nlm") && sigma_voxels > MAX_SIGMA_VOXELS {
            return Err(format!(
                "wanted a SIGMA of at most {MAX_SIGMA_VOXELS} voxels, found {sigma_voxels}"
            ));
        }
        let filter = match (kind, numbers.len()) {
            (Some("gaussian"), 0..=1) => Denoise::Gaussian { sigma_voxels },
            (Some("median"), 0) => Denoise::Median,
            (Some("bilateral"), 0..=2) => Denoise::Bilateral {
                sigma_voxels,
                sigma_value: numbers.get(1).copied(),
            },
            (Some("nlm"), 0..=1) => Denoise::NonLocalMeans {
                sigma_value: numbers.first().copied(),
            },
            _ => return Err(wanted()),
        };
        Ok(Self(filter))
    }
}

impl fmt::Display for DenoiseWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Denoise::Gaussian { sigma_voxels } => write!(f, "gaussian:{sigma_voxels}"),
            Denoise::Median => f.write_str("median"),
            Denoise::Bilateral {
                sigma_voxels,
                sigma_value: None,
            } => write!(f, "bilateral:{sigma_voxels}"),
            Denoise::Bilateral {
                sigma_voxels,
                sigma_value: Some(value),
            } => write!(f, "bilateral:{sigma_voxels}:{value}"),
            Denoise::NonLocalMeans { sigma_value: None } => f.write_str("nlm"),
            Denoise::NonLocalMeans {
                sigma_value: Some(value),
            } => write!(f, "nlm:{value}"),
        }
    }
}

impl TryFrom<String> for DenoiseWord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<DenoiseWord> for String {
    fn from(word: DenoiseWord) -> Self {
        word.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_read_as_they_are_written() {
        for text in [
            "gaussian:1.2",
            "median",
            "bilateral:1",
            "bilateral:1.5:20",
            "nlm",
            "nlm:35.5",
        ] {
            let word: DenoiseWord = text.parse().expect("a filter");
            assert_eq!(word.to_string(), text);
        }
        for text in [
            "",
            "blur",
            "median:3",
            "gaussian:0",
            "gaussian:9",
            "bilateral:1:2:3",
            "nlm:0",
            "nlm:1:2",
        ] {
            assert!(text.parse::<DenoiseWord>().is_err(), "{text}");
        }
    }
}
