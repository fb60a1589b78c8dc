//! How lines look in a picture: the words.

use super::drawn::Width;
use super::flags::duration;
use crate::cli::{Error, flags::Numbers};
use crate::figure::short;
use crate::transfer::Colormap;
use crate::volume::{Grid, Header};
use clap::{Args, ValueEnum};
use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// What stands for a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StyleWord {
    /// A tube
    #[default]
    Tube,
    /// A tube with heads along the wind
    Arrows,
    /// A head with a tail that grows thin: particles that move in a film
    Comets,
    /// Spheres at equal times, which are said: the farther apart the faster
    Points,
    /// A flat strip that turns as the air does
    Ribbons,
}

/// The words, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FlowStyleFlags {
    /// What stands for a line [default: arrows for stream, else tube]
    #[arg(long, value_enum, value_name = "STYLE", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow_style: Option<StyleWord>,
    /// How long comets are: seconds, or with s, min, h or d [default: the whole of a stream line; of path lines an eighth of
    /// the times of the file]
    #[arg(long, value_name = "T", value_parser = duration, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub comet_time: Option<f64>,
    /// Width of lines in pixels, where the camera is turned to, up to an eighth of the height of the picture; or with km
    /// in kilometres of the Earth [default: 3, of the heads of comets 6, of spheres 8, of ribbons 12]
    #[arg(long, value_name = "PX|Nkm", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow_width: Option<WidthWord>,
    /// Values at the ends of the colours of lines [default: from 0 to what 99.9 % of them are under]
    #[arg(long, value_name = "LO,HI", allow_hyphen_values = true, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow_range: Option<Numbers<2>>,
    /// The colours of lines [default: plasma from yellow to violet, the strongest]
    #[arg(long, value_name = "NAME", value_parser = map, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow_colormap: Option<String>,
    /// Draw lines without the volume
    #[arg(long, help_heading = HEADING)]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub hide_volume: bool,
}

impl FlowStyleFlags {
    /// The first of these words that says how lines look.
    pub fn word(&self) -> Option<&'static str> {
        let words = [
            ("--flow-style", self.flow_style.is_some()),
            ("--comet-time", self.comet_time.is_some()),
            ("--flow-width", self.flow_width.is_some()),
            ("--flow-range", self.flow_range.is_some()),
            ("--flow-colormap", self.flow_colormap.is_some()),
        ];
        let mut given = words.into_iter().filter(|&(_, is_given)| is_given);
        given.next().map(|(word, _)| word)
    }

    /// What can be refused before anything is read; `height` is the one of the picture in pixels.
    pub fn check(&self, height: u32) -> Result<(), Error> {
        if let Some(range) = self.flow_range {
            range.check_rises("--flow-range", "0,30")?;
        }
        let most = (WIDEST_PART * f64::from(height)).max(WIDEST_AT_LEAST);
        match self.flow_width {
            Some(WidthWord::Pixels(width)) if width > most => Err(Error::usage(
                format!(
                    "--flow-width {width}: wanted at most {most} pixels of a picture of {height} rows"
                ),
                format!("--flow-width {most}"),
            )),
            _ => Ok(()),
        }
    }
}

/// How wide lines are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum WidthWord {
    /// Where the camera is turned to.
    Pixels(f64),
    /// On the Earth.
    Kilometres {
        /// How many.
        km: f64,
    },
}

impl WidthWord {
    /// The same in the world of a volume.
    pub(super) fn in_world(self, header: &Header) -> Result<Width, Error> {
        let km = match self {
            Self::Pixels(pixels) => return Ok(Width::Pixels(pixels)),
            Self::Kilometres { km } => km,
        };
        let metres = header.length_metres.filter(|_| header.is_earth);
        let metres = metres.ok_or_else(|| {
            Error::usage(
                format!("--flow-width {km}km is of the Earth, and the volume does not lie there"),
                "--flow-width N is in pixels",
            )
        })?;
        let grid = Grid {
            dims: header.dims,
            world_from_voxel: header.world_from_voxel,
        };
        let (width, most) = (1000.0 * km / metres, WIDEST_PART * grid.diagonal());
        match width > 0.0 && width <= most {
            true => Ok(Width::World(width)),
            false => Err(Error::usage(
                format!(
                    "--flow-width {km}km: wanted over 0 and at most {}km, an eighth of the diagonal of the volume",
                    short(most * metres / 1000.0)
                ),
                "--flow-width 3 is in pixels",
            )),
        }
    }
}

impl FromStr for WidthWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (number, is_km) = match text.strip_suffix("km") {
            Some(number) => (number, true),
            None => (text, false),
        };
        let number = number.trim().parse().ok();
        let least = if is_km { 1e-6 } else { THINNEST_PIXELS };
        let number =
            number.filter(|n: &f64| (least..=if is_km { 1e5 } else { 1000.0 }).contains(n));
        let number = number.ok_or_else(|| {
            format!(
                "wanted {THINNEST_PIXELS} to 1000 pixels: a thinner line is missed by pixels, or a length such as 20km, found {text}"
            )
        })?;
        Ok(match is_km {
            true => Self::Kilometres { km: number },
            false => Self::Pixels(number),
        })
    }
}

const HEADING: &str = "Lines";

/// Lines are no broader than this part of the height of the picture, or than these pixels: each would cover most of it.
const WIDEST_PART: f64 = 0.125;
const WIDEST_AT_LEAST: f64 = 16.0;

/// A line is no thinner, else pixels miss it.
pub(super) const THINNEST_PIXELS: f64 = 1.2;

fn map(text: &str) -> Result<String, String> {
    match Colormap::from_name(text) {
        Some(_) => Ok(text.to_owned()),
        None => Err(
            "wanted the name of a colour map: `stratavox render --help` lists them at --colormap"
                .to_owned(),
        ),
    }
}
