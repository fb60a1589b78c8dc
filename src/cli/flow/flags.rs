//! The words of lines along a wind.

use super::super::Error;
use crate::flow::{Direction, Seeds};
use clap::{Args, ValueEnum};
use serde::{Deserialize, Serialize};
use std::{fmt::Display, str::FromStr};

/// Which lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FlowWord {
    /// Along the wind of one time
    Stream,
    /// The ways of particles
    Path,
    /// Where particles are that left one place after another
    Streak,
}

impl FlowWord {
    /// The word itself.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stream => "stream",
            Self::Path => "path",
            Self::Streak => "streak",
        }
    }
}

/// Which way lines go from their seeds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DirectionWord {
    /// Both ways
    Both,
    /// With the wind
    Forward,
    /// Against it
    Backward,
}

impl From<DirectionWord> for Direction {
    fn from(word: DirectionWord) -> Self {
        match word {
            DirectionWord::Both => Self::Both,
            DirectionWord::Forward => Self::Forward,
            DirectionWord::Backward => Self::Backward,
        }
    }
}

/// What colours a line, or is written as its value.
#[derive(Clone, Debug, PartialEq)]
pub enum FlowColor {
    /// A variable.
    Variable(String),
    /// One colour, sRGB, 0 to 1.
    One([f32; 3]),
}

impl FromStr for FlowColor {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> = text.split(':').collect();
        let numbers: Option<Vec<f32>> = parts.iter().map(|part| part.parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[r, g, b]) if [r, g, b].iter().all(|n| (0.0..=1.0).contains(n)) => {
                Ok(Self::One([r, g, b]))
            }
            Some(&[_, _, _]) => Err("wanted R:G:B, each from 0 to 1".to_owned()),
            _ if text.is_empty() => Err("wanted the name of a variable, or R:G:B".to_owned()),
            _ => Ok(Self::Variable(text.to_owned())),
        }
    }
}

/// The variables of the wind by name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WindWords {
    pub east: String,
    pub north: String,
    /// `None` where the file says; `Some(None)` for none.
    pub up: Option<Option<String>>,
}

impl FromStr for WindWords {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let names: Vec<&str> = text.split(',').map(str::trim).collect();
        let (east, north, up) = match names.as_slice() {
            [east, north] => (east, north, None),
            [east, north, "none"] => (east, north, Some(None)),
            [east, north, up] => (east, north, Some(Some((*up).to_owned()))),
            _ => return Err(format!("wanted U,V or U,V,W or U,V,none, found {text:?}")),
        };
        if names.iter().any(|name| name.is_empty()) {
            return Err(format!(
                "wanted the name of a variable at each place, found {text:?}"
            ));
        }
        for (k, name) in names.iter().enumerate() {
            if names[..k].contains(name) {
                return Err(format!(
                    "wanted another variable at each place, found {name} twice in {text:?}"
                ));
            }
        }
        Ok(Self {
            east: (*east).to_owned(),
            north: (*north).to_owned(),
            up,
        })
    }
}

/// The words, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FlowFlags {
    /// Lines along the wind of INPUT: of the wind of one time, of particles, or of smoke
    #[arg(long, value_enum, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow: Option<FlowWord>,
    /// Where lines begin: even[:D] lines that keep a distance, grid:NX,NY,NZ, random:N[,SEED], plane:x|y|z=V,N (N times N),
    /// rake:X,Y,Z,X,Y,Z,N, where:VAR>V,N, or a file .csv of x,y,z[,t] or lon,lat,height|pressure|level[,t]
    /// [default: even; of particles random:200]
    #[arg(
        long,
        value_name = "SEEDS",
        allow_hyphen_values = true,
        value_parser = word_of::<Seeds>,
        help_heading = HEADING
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow_seeds: Option<String>,
    /// Which way lines go from their seeds [default: both, of particles forward]
    #[arg(
        long,
        value_enum,
        value_name = "WAY",
        help_heading = HEADING
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow_direction: Option<DirectionWord>,
    /// What is written as the value of each vertex and colours tubes: a variable, or for tubes one colour R:G:B, 0 to 1
    /// [default: the true speed]
    #[arg(
        long,
        value_name = "VAR|R:G:B",
        value_parser = word_of::<FlowColor>,
        help_heading = HEADING
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow_color: Option<String>,
    /// Lines are no longer, each way, in world length
    #[arg(long, value_name = "L", value_parser = positive, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow_length: Option<f64>,
    /// Lines are followed no longer, each way: seconds, or with s, min, h or d
    #[arg(long, value_name = "T", value_parser = duration, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow_time: Option<f64>,
    /// The variables of the wind: to the east, to the north, upwards [default: by their standard names, then U and V, u and
    /// v ...]
    #[arg(
        long,
        value_name = "U,V[,W|none]",
        value_parser = word_of::<WindWords>,
        help_heading = HEADING
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wind: Option<String>,
}

const HEADING: &str = "Lines";

impl FlowFlags {
    /// How seeds are chosen, where that is said.
    pub(super) fn seeds(&self) -> Result<Option<Seeds>, Error> {
        parsed("--flow-seeds", self.flow_seeds.as_deref())
    }

    /// What colours lines, where that is said.
    pub(super) fn color(&self) -> Result<Option<FlowColor>, Error> {
        parsed("--flow-color", self.flow_color.as_deref())
    }

    /// The first of these words that says how lines go, where there are none.
    pub fn word_without_lines(&self) -> Option<&'static str> {
        let words = [
            ("--flow-seeds", self.flow_seeds.is_some()),
            ("--flow-direction", self.flow_direction.is_some()),
            ("--flow-color", self.flow_color.is_some()),
            ("--flow-length", self.flow_length.is_some()),
            ("--flow-time", self.flow_time.is_some()),
        ];
        let mut given = words.into_iter().filter(|&(_, is_given)| is_given);
        let first = given.next().map(|(word, _)| word);
        first.filter(|_| self.flow.is_none())
    }

    /// The variables of the wind, where they are said.
    pub fn wind_words(&self) -> Result<Option<WindWords>, Error> {
        parsed("--wind", self.wind.as_deref())
    }
}

/// A word as it was said, if it can be read.
fn word_of<T: FromStr<Err: Display>>(text: &str) -> Result<String, String> {
    match text.parse::<T>() {
        Ok(_) => Ok(text.to_owned()),
        Err(problem) => Err(problem.to_string()),
    }
}

/// A scene file may say anything.
fn parsed<T: FromStr<Err: Display>>(flag: &str, text: Option<&str>) -> Result<Option<T>, Error> {
    let parse = |text: &str| {
        let read = text.parse();
        read.map_err(|problem: T::Err| {
            Error::usage(
                format!("{flag} {text}: {problem}"),
                "`stratavox render --help` shows what it may be",
            )
        })
    };
    text.map(parse).transpose()
}

fn positive(text: &str) -> Result<f64, String> {
    let number = text
        .parse()
        .ok()
        .filter(|n: &f64| *n > 0.0 && n.is_finite());
    number.ok_or_else(|| "wanted a number over 0".to_owned())
}

/// Seconds of a word.
pub(super) fn duration(text: &str) -> Result<f64, String> {
    let units = [("min", 60.0), ("s", 1.0), ("h", 3600.0), ("d", 86400.0)];
    let with_unit = units.iter().find_map(|&(unit, seconds)| {
        let number = text.strip_suffix(unit)?;
        Some((number.trim(), seconds))
    });
    let (number, seconds) = with_unit.unwrap_or((text, 1.0));
    let seconds = positive(number).map(|n| n * seconds);
    seconds.map_err(|_| "wanted a time over 0, such as 600, 30min, 6h or 5d".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_times_colours_and_winds() {
        assert_eq!(duration("90"), Ok(90.0));
        assert_eq!(duration("30min"), Ok(1800.0));
        assert_eq!(duration("1.5h"), Ok(5400.0));
        assert!(duration("-1h").is_err() && duration("h").is_err());
        assert_eq!("1:0.5:0".parse(), Ok(FlowColor::One([1.0, 0.5, 0.0])));
        assert_eq!("W".parse(), Ok(FlowColor::Variable("W".to_owned())));
        assert!("2:0:0".parse::<FlowColor>().is_err());
        let up = |text: &str| text.parse::<WindWords>().map(|wind| wind.up);
        assert_eq!(up("U,V"), Ok(None));
        assert_eq!(up("U,V,none"), Ok(Some(None)));
        assert_eq!(up("U, V, W"), Ok(Some(Some("W".to_owned()))));
        assert!(up("U").is_err() && up("U,,W").is_err());
        assert!(up("U,U").is_err() && up("U, V, U").is_err());
    }
}
