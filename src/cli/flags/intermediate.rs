//! How fine the intermediate image of shear-warp is: `voxels`, `pixels`, or a number of base pixels a voxel.

use super::positive;
use crate::technique::Intermediate;
use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

/// An [`Intermediate`] as options and scene files name it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct IntermediateWord(pub Intermediate);

impl FromStr for IntermediateWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Ok(Self(match text {
            "voxels" => Intermediate::PerVoxel(1.0),
            "pixels" => Intermediate::Pixels,
            number => positive(number)
                .map(Intermediate::PerVoxel)
                .map_err(|_| format!("wanted voxels, pixels or a number over 0, found {number}"))?,
        }))
    }
}

impl fmt::Display for IntermediateWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Intermediate::PerVoxel(1.0) => f.write_str("voxels"),
            Intermediate::PerVoxel(number) => number.fmt(f),
            Intermediate::Pixels => f.write_str("pixels"),
        }
    }
}

impl TryFrom<String> for IntermediateWord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<IntermediateWord> for String {
    fn from(word: IntermediateWord) -> Self {
        word.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_and_numbers_are_read_and_written_alike() {
        for (text, wanted) in [
            ("voxels", Intermediate::PerVoxel(1.0)),
            ("pixels", Intermediate::Pixels),
            ("2.5", Intermediate::PerVoxel(2.5)),
        ] {
            let found: IntermediateWord = text.parse().expect("a word");
            assert_eq!((found.0, found.to_string()), (wanted, text.to_owned()));
        }
        for text in ["", "0", "-1", "nan", "inf", "voxel"] {
            let refused = text
                .parse::<IntermediateWord>()
                .expect_err("no number over 0");
            assert!(refused.contains("found"), "{refused}");
        }
    }
}
