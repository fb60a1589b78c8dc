//! `--component`: one of the numbers of a voxel, their length, or all of them.

use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// What is taken of the numbers of a voxel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Component {
    /// The one of this number, counted from 0.
    Number(u32),
    /// A word.
    Word(Word),
}

/// The words in the place of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Word {
    /// The length of the vector that they are.
    Magnitude,
    /// Each of them, in a colour of its own.
    All,
}

#[allow(
    non_upper_case_globals,
    reason = "they read as the variants they stand for"
)]
impl Component {
    /// The length of the vector.
    pub const Magnitude: Self = Self::Word(Word::Magnitude);
    /// Each in a colour of its own.
    pub const All: Self = Self::Word(Word::All);
}

impl FromStr for Component {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "magnitude" => Ok(Self::Magnitude),
            "all" => Ok(Self::All),
            number => number.parse().map(Self::Number).map_err(|_| {
                format!("wanted a number counted from 0, magnitude, or all, found {number:?}")
            }),
        }
    }
}
