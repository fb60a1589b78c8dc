//! Scattered points on a grid: the words, and the volume that they make.

use super::numbers::positive;
use super::{Error, InputFlags};
use crate::cli::{exaggerate, memory::in_units};
use crate::format::PointFile;
use crate::named::Named;
use crate::points::interpolate::{GridSize, Method, NoField, Options};
use crate::volume::{Grid, Source};
use clap::builder::{EnumValueParser, PossibleValue, TypedValueParser};
use clap::error::ErrorKind;
use clap::{Arg, Args, Command, ValueEnum};
use glam::{DAffine3, DMat3, DVec3};
use serde::{Deserialize, Serialize};
use std::{ffi::OsStr, fmt, str::FromStr};

/// The words, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PointGridFlags {
    /// Scattered points on a grid: auto (half the mean distance of neighbours, at most 256 voxels a side), NXxNYxNZ voxels,
    /// or the edge of a voxel [default: auto]
    #[arg(
        long,
        value_name = "auto|NXxNYxNZ|SPACING",
        help_heading = "Scattered points"
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grid: Option<GridWord>,
    /// How values between points are made [default: shepard]
    #[arg(
        long,
        value_parser = MethodParser,
        value_name = "METHOD",
        help_heading = "Scattered points"
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interpolate: Option<Method>,
    /// Farther than this from all points there are no data; the radius of kernels [default: 3 mean distances of neighbours]
    #[arg(long, value_name = "LENGTH", value_parser = positive, help_heading = "Scattered points")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reach: Option<f64>,
    /// How many times heights count in distances between points [default: --exaggerate, or on the Earth what the box of the points
    /// would be exaggerated by]
    #[arg(long, value_name = "FACTOR", value_parser = positive, help_heading = "Scattered points")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub anisotropy: Option<f64>,
}

/// Methods by their names; those that are known and not there are refused as such.
#[derive(Clone, Copy, Debug)]
struct MethodParser;

/// Names of these.
const NOT_BUILT: [&str; 2] = ["natural", "thin-plate"];

impl TypedValueParser for MethodParser {
    type Value = Method;

    fn parse_ref(
        &self,
        command: &Command,
        arg: Option<&Arg>,
        value: &OsStr,
    ) -> Result<Method, clap::Error> {
        if NOT_BUILT.iter().any(|name| value == *name) {
            let names: Vec<_> = Method::ALL.iter().map(|method| method.name()).collect();
            return Err(clap::Error::raw(
                ErrorKind::InvalidValue,
                format!(
                    "--interpolate {}: not built yet, wanted one of {}\n",
                    value.display(),
                    names.join(", ")
                ),
            )
            .with_cmd(command));
        }
        EnumValueParser::new().parse_ref(command, arg, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let all = Method::value_variants().iter();
        Some(Box::new(all.filter_map(ValueEnum::to_possible_value)))
    }
}

/// `auto`, `64x64x32` or `0.5`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct GridWord(pub GridSize);

/// The words with what else decides about distances.
#[derive(Clone, Debug, PartialEq)]
pub struct PointGrid {
    /// The words.
    pub flags: PointGridFlags,
    /// How much higher a picture is drawn, where a word says it.
    pub exaggerate: Option<f64>,
}

impl PointGridFlags {
    /// True where a word is given.
    pub fn are_given(&self) -> bool {
        *self != Self::default()
    }
}

impl PointGrid {
    /// The volume of points on the grid.
    pub fn volume_of(&self, file: PointFile, input: &InputFlags) -> Result<PointFile, Error> {
        let GridWord(size) = self.flags.grid.unwrap_or_default();
        let options = Options {
            method: self.flags.interpolate.unwrap_or_default(),
            reach: self.flags.reach,
            anisotropy: self.anisotropy(&file),
        };
        let path = file.path().to_owned();
        // Streams have no limit of their own, and this volume is in memory all the same.
        let max_bytes = input.limits().max_bytes;
        file.interpolated(&options, size, max_bytes)
            .map_err(|problem| {
                Error::usage(
                    format!("{}: {}", path.display(), said(&problem)),
                    hint(&problem, size),
                )
            })
    }

    /// By the words, or as the box of the points would be exaggerated.
    fn anisotropy(&self, file: &PointFile) -> f64 {
        let given = self.flags.anisotropy.or(self.exaggerate);
        given.unwrap_or_else(|| match file.header().is_earth {
            true => exaggerate::suggested(&box_of(file.points().places())),
            false => 1.0,
        })
    }
}

/// The box of places, as a grid of few voxels.
fn box_of(places: &[DVec3]) -> Grid {
    let low = places
        .iter()
        .copied()
        .reduce(DVec3::min)
        .unwrap_or_default();
    let high = places
        .iter()
        .copied()
        .reduce(DVec3::max)
        .unwrap_or_default();
    Grid {
        dims: [2; 3],
        world_from_voxel: DAffine3 {
            matrix3: DMat3::from_diagonal(0.5 * (high - low)),
            translation: low,
        },
    }
}

fn said(problem: &NoField) -> String {
    match problem {
        NoField::TooLarge {
            voxels: [nx, ny, nz],
            bytes,
            max_bytes,
        } => format!(
            "a grid of {nx} x {ny} x {nz} voxels takes {}, and {} may be taken",
            in_units(*bytes),
            in_units(*max_bytes)
        ),
        _ => problem.to_string(),
    }
}

fn hint(problem: &NoField, size: GridSize) -> &'static str {
    match problem {
        NoField::TooFew { .. } => "--interpolate idw",
        NoField::OnOneLine => "draw them as they are: render --points-as splats",
        NoField::NoLength => "--reach 10 --anisotropy 1",
        NoField::TooLarge { .. } if size == GridSize::Auto => "--grid 64x64x64",
        NoField::TooLarge { .. } | NoField::NoVoxel => "--grid auto",
    }
}

impl FromStr for GridWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "auto" {
            return Ok(Self(GridSize::Auto));
        }
        let counts: Option<Vec<u32>> = text.split('x').map(|count| count.parse().ok()).collect();
        let counts = counts.and_then(|counts| <[u32; 3]>::try_from(counts).ok());
        if let Some(counts) = counts.filter(|counts| !counts.contains(&0)) {
            return Ok(Self(GridSize::Voxels(counts)));
        }
        match positive(text) {
            Ok(spacing) => Ok(Self(GridSize::Spacing(spacing))),
            Err(_) => Err(format!(
                "wanted auto, voxels such as 64x64x32, or the edge of one over 0, found {text:?}"
            )),
        }
    }
}

impl fmt::Display for GridWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            GridSize::Auto => f.write_str("auto"),
            GridSize::Voxels([x, y, z]) => write!(f, "{x}x{y}x{z}"),
            GridSize::Spacing(spacing) => spacing.fmt(f),
        }
    }
}

impl TryFrom<String> for GridWord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<GridWord> for String {
    fn from(word: GridWord) -> Self {
        word.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_is_a_word_counts_or_a_length() {
        let size = |text: &str| text.parse().map(|GridWord(size)| size);
        assert_eq!(size("auto"), Ok(GridSize::Auto));
        assert_eq!(size("64x32x1"), Ok(GridSize::Voxels([64, 32, 1])));
        assert_eq!(size("0.25"), Ok(GridSize::Spacing(0.25)));
        for text in [
            "",
            "64x64",
            "0x4x4",
            "-1",
            "0",
            "nan",
            "4x4x4x4",
            "4294967296x1x1",
            "fine",
        ] {
            assert!(size(text).is_err(), "{text}");
        }
        for text in ["auto", "64x32x1", "0.25", "1e-7"] {
            let word: GridWord = text.parse().expect("a word");
            assert_eq!(word.to_string().parse(), Ok(word), "{text}");
        }
    }
}
