//! Surfaces: which values, in which colours.

use super::{Error, channels::color_of};
use crate::{
    picture::ColorSpace,
    shaders::MAX_LEVELS,
    technique::Level,
    transfer::{Absorption, Points, TransferFunction, ValueSummary, classify_by_points, levels},
};
use clap::Args;
use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

/// The flags, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LevelFlags {
    /// iso: the values of which surfaces are drawn [default: by the values]
    #[arg(long, value_name = "VALUE,...", value_delimiter = ',', value_parser = super::finite, allow_hyphen_values = true, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub iso: Vec<f64>,
    /// iso: the colour of each value [default: as the transfer function has it]
    #[arg(long, value_name = "NAME|R:G:B,...", value_delimiter = ',', help_heading = HEADING)]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub iso_color: Vec<ColorWord>,
    /// iso: the opacity of each value, 0 to 1 [default: 1 for the last, 0.25 for those before it]
    #[arg(long, value_name = "A,...", value_delimiter = ',', value_parser = super::finite, allow_hyphen_values = true, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub iso_opacity: Vec<f64>,
}

const HEADING: &str = "Modes";

/// What a surface takes of the light of those that are named after it.
const THIN: f64 = 0.25;

/// `R:G:B` or a name; sRGB.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct ColorWord([f64; 3]);

impl FromStr for ColorWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        color_of(text).map(Self)
    }
}

impl fmt::Display for ColorWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [r, g, b] = self.0;
        write!(f, "{r}:{g}:{b}")
    }
}

impl TryFrom<String> for ColorWord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<ColorWord> for String {
    fn from(color: ColorWord) -> Self {
        color.to_string()
    }
}

impl LevelFlags {
    /// What can be said wrong before a voxel is read.
    pub fn check(&self) -> Result<(), Error> {
        let (values, limit) = (self.iso.len(), MAX_LEVELS as usize);
        if values > limit {
            return Err(Error::usage(
                format!("--iso: {values} values, at most {limit} are possible"),
                "--iso -300,250",
            ));
        }
        let lists = [
            ("--iso-color", self.iso_color.len()),
            ("--iso-opacity", self.iso_opacity.len()),
        ];
        for (flag, found) in lists {
            if found > 0 && found != values {
                return Err(Error::usage(
                    format!("{flag} says something of {found} values, and --iso names {values}"),
                    "--iso -300,250 --iso-color orange,white --iso-opacity 0.3,1",
                ));
            }
        }
        match self.iso_opacity.iter().find(|a| !(0.0..=1.0).contains(*a)) {
            Some(found) => Err(Error::usage(
                format!("--iso-opacity {found}: wanted numbers from 0 to 1"),
                "--iso -300,250 --iso-opacity 0.3,1",
            )),
            None => Ok(()),
        }
    }

    /// The surfaces, coloured by `function` where no word says how, and what a person should know of them.
    pub fn levels(
        &self,
        function: &TransferFunction,
        summary: impl FnOnce() -> Result<ValueSummary, Error>,
    ) -> Result<(Vec<Level>, Option<String>), Error> {
        let (values, note) = if self.iso.is_empty() {
            let chosen = levels(&summary()?);
            let words: Vec<_> = chosen
                .iter()
                .map(|(value, _)| format!("{value:.6}"))
                .collect();
            let note = format!(
                "surfaces of the value {}; --iso takes others",
                words.join(" and of ")
            );
            (chosen, Some(note))
        } else {
            let last = self.iso.len() - 1;
            let opacity = |i: usize| {
                let by_order = if i == last { 1.0 } else { THIN };
                self.iso_opacity.get(i).copied().unwrap_or(by_order)
            };
            let values = self.iso.iter().enumerate();
            (
                values.map(|(i, &value)| (value, opacity(i))).collect(),
                None,
            )
        };
        // As the function has it in sRGB numbers.
        let points = Points::new(function, Absorption::Opacity, ColorSpace::Display);
        let of_function = |value: f64| {
            let [r, g, b, _] = classify_by_points(&points, value);
            [r, g, b]
        };
        let level = |(i, (value, opacity)): (usize, (f64, f64))| Level {
            value,
            srgb: match self.iso_color.get(i) {
                Some(color) => color.0,
                None => of_function(value),
            },
            opacity,
        };
        Ok((values.into_iter().enumerate().map(level).collect(), note))
    }

    /// True where no word is given.
    pub fn say_nothing(&self) -> bool {
        *self == Self::default()
    }
}
