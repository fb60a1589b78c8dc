//! Light from all around that matter takes away: the word of `--ambient-occlusion`.

use super::Numbers;
use crate::technique::AmbientOcclusion;
use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

/// `STRENGTH` or `STRENGTH,RADIUS`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct OcclusionWord(AmbientOcclusion);

impl OcclusionWord {
    /// What it stands for.
    pub fn occlusion(self) -> AmbientOcclusion {
        self.0
    }
}

impl FromStr for OcclusionWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (strength, radius_world) = match text.matches(',').count() {
            0 => (Numbers::<1>::from_str(text)?.0[0], None),
            1 => {
                let [strength, radius] = Numbers::<2>::from_str(text)?.0;
                (strength, Some(radius))
            }
            _ => return Err("wanted STRENGTH or STRENGTH,RADIUS".to_owned()),
        };
        if !(0.0..=1.0).contains(&strength) {
            return Err("wanted a strength from 0 to 1".to_owned());
        }
        if radius_world.is_some_and(|radius| radius <= 0.0) {
            return Err("wanted a radius over 0, in world length".to_owned());
        }
        Ok(Self(AmbientOcclusion {
            strength,
            radius_world,
        }))
    }
}

impl fmt::Display for OcclusionWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0.strength)?;
        match self.0.radius_world {
            Some(radius) => write!(f, ",{radius}"),
            None => Ok(()),
        }
    }
}

impl TryFrom<String> for OcclusionWord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<OcclusionWord> for String {
    fn from(word: OcclusionWord) -> Self {
        word.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_occlusion_comes_back_from_its_own_text() {
        for text in ["0.5", "1,12.5", "0"] {
            let word: OcclusionWord = text.parse().expect("an occlusion");
            assert_eq!(word.to_string(), text);
        }
    }

    #[test]
    fn what_is_no_occlusion_is_refused_with_a_reason() {
        for (text, wanted) in [
            ("1.5", "from 0 to 1"),
            ("-0.1", "from 0 to 1"),
            ("0.5,0", "over 0"),
            ("0.5,1,2", "STRENGTH,RADIUS"),
            ("much", "a number"),
        ] {
            let problem = text.parse::<OcclusionWord>().expect_err("refused");
            assert!(problem.contains(wanted), "{text}: {problem}");
        }
    }
}
