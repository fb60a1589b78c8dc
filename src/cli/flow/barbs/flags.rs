//! `--barbs[=LEVEL|HEIGHT][,STEP]`: the words.

use crate::cli::flags::{ColorWord, LevelOrHeight};
use clap::Args;
use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

/// Where barbs stand, and how far apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct BarbWords {
    /// `None`: the lowest place of each column that has a wind.
    pub place: Option<LevelOrHeight>,
    /// Columns from barb to barb, along x and along y; `None`: so that there are some twelve by nine.
    pub step: Option<u32>,
}

/// The words, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BarbFlags {
    /// Draw wind barbs: half a feather 5 knots, a feather 10, a flag 50, to the side of the low pressure, a circle where it
    /// is calm. At a level counted from 0 at the lowest, or at a height such as 500m, 1.5km or 850hPa; every STEP columns
    /// [default: the lowest level with a wind, some 12 x 9 barbs]
    #[arg(
        long,
        value_name = "LEVEL|HEIGHT[,STEP]",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "",
        help_heading = "Lines"
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub barbs: Option<BarbWords>,
    /// Colour of wind barbs [default: light, on a light background and on the ground dark]
    #[arg(long, value_name = "COLOR", requires = "barbs", help_heading = "Lines")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub barb_color: Option<ColorWord>,
}

impl FromStr for BarbWords {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (place, step) = match text.split_once(',') {
            Some((place, step)) => (place, Some(step)),
            None => (text, None),
        };
        let step = step.map(|step| {
            let number = step.parse().ok().filter(|&n: &u32| n > 0);
            number.ok_or_else(|| {
                format!("wanted a whole number of columns over 0 after the comma, found {step:?}")
            })
        });
        Ok(Self {
            place: match place {
                "" => None,
                place => Some(place.parse()?),
            },
            step: step.transpose()?,
        })
    }
}

impl fmt::Display for BarbWords {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = self.place {
            write!(f, "{place}")?;
        }
        match self.step {
            Some(step) => write!(f, ",{step}"),
            None => Ok(()),
        }
    }
}

impl TryFrom<String> for BarbWords {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<BarbWords> for String {
    fn from(words: BarbWords) -> Self {
        words.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_a_place_and_a_step_and_come_back() {
        for (text, place, step) in [
            ("", None, None),
            ("3", Some(LevelOrHeight::Level(3)), None),
            ("850hPa,4", Some(LevelOrHeight::Pascals(85_000.0)), Some(4)),
            (",6", None, Some(6)),
            ("10m", Some(LevelOrHeight::Metres(10.0)), None),
        ] {
            let found: BarbWords = text.parse().expect(text);
            assert_eq!(found, BarbWords { place, step });
            assert_eq!(found.to_string(), text);
        }
        for text in ["x", "3,0", "3,-1", "3,4,5", "1.5"] {
            assert!(text.parse::<BarbWords>().is_err(), "{text}");
        }
    }
}
