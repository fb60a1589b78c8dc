//! `--ground VAR[,LEVEL|HEIGHT]`: the words.

use crate::cli::flags::{LevelOrHeight, Numbers};
use crate::transfer::Colormap;
use clap::Args;
use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

/// What colours the ground.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct GroundWord {
    /// A variable of one number a column, or of a level.
    pub variable: String,
    /// `None`: the lowest number of each column.
    pub place: Option<LevelOrHeight>,
}

/// The words, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GroundFlags {
    /// Colour the ground by a variable of one number a column, such as T2, or by a level of another: a level counted from 0
    /// at the lowest, or a height such as 500m, 1.5km or 850hPa [default: the lowest number of each column]
    #[arg(long, value_name = "VAR[,LEVEL|HEIGHT]", help_heading = "Lines")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ground: Option<GroundWord>,
    /// Values at the ends of the colours of the ground [default: the least and the greatest, in films of all times]
    #[arg(
        long,
        value_name = "LO,HI",
        allow_hyphen_values = true,
        requires = "ground",
        help_heading = "Lines"
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ground_range: Option<Numbers<2>>,
    /// The colours of the ground [default: by what the variable is, else viridis]
    #[arg(long, value_name = "NAME[,reverse]", value_parser = map, requires = "ground", help_heading = "Lines")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ground_colormap: Option<String>,
}

fn map(text: &str) -> Result<String, String> {
    text.parse::<Colormap>().map(|_| text.to_owned())
}

impl FromStr for GroundWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        // A variable in brackets may have commas: T[number=1,expver=5].
        let at = text.rfind(',').filter(|at| !text[*at..].contains(']'));
        let (variable, place) = match at {
            Some(at) => (&text[..at], Some(text[at + 1..].parse()?)),
            None => (text, None),
        };
        match variable.trim() {
            "" => Err(format!("wanted the name of a variable, found {text:?}")),
            variable => Ok(Self {
                variable: variable.to_owned(),
                place,
            }),
        }
    }
}

impl fmt::Display for GroundWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.variable)?;
        match self.place {
            Some(place) => write!(f, ",{place}"),
            None => Ok(()),
        }
    }
}

impl TryFrom<String> for GroundWord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<GroundWord> for String {
    fn from(word: GroundWord) -> Self {
        word.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_a_variable_and_a_place_and_come_back() {
        for (text, variable, place) in [
            ("T2", "T2", None),
            (
                "temperature,850hPa",
                "temperature",
                Some(LevelOrHeight::Pascals(85_000.0)),
            ),
            ("t[number=1,expver=5]", "t[number=1,expver=5]", None),
            (
                "t[number=1,expver=5],3",
                "t[number=1,expver=5]",
                Some(LevelOrHeight::Level(3)),
            ),
        ] {
            let found: GroundWord = text.parse().expect(text);
            assert_eq!((found.variable.as_str(), found.place), (variable, place));
            assert_eq!(found.to_string(), text);
        }
        for text in ["", ",3", "T2,x", "T2,1.5"] {
            assert!(text.parse::<GroundWord>().is_err(), "{text}");
        }
    }
}
