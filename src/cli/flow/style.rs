//! How lines look in a picture: the words.

use super::flags::duration;
use crate::cli::flags::Numbers;
use crate::transfer::Colormap;
use clap::{Args, ValueEnum};
use serde::{Deserialize, Serialize};

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
}

/// The words, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FlowStyleFlags {
    /// What stands for a line [default: arrows for stream, else tube]
    #[arg(long, value_enum, value_name = "STYLE", requires = "flow", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow_style: Option<StyleWord>,
    /// How long comets are: seconds, or with s, min, h or d [default: the whole of a stream line; of path lines an eighth of
    /// the times of the file]
    #[arg(long, value_name = "T", value_parser = duration, requires = "flow", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub comet_time: Option<f64>,
    /// Width of lines in pixels, where the camera is turned to [default: 3, of the heads of comets 6]
    #[arg(long, value_name = "PX", value_parser = width, requires = "flow", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow_width: Option<f64>,
    /// Values at the ends of the colours of lines [default: from 0 to what 99.9 % of them are under]
    #[arg(long, value_name = "LO,HI", allow_hyphen_values = true, requires = "flow", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow_range: Option<Numbers<2>>,
    /// The colours of lines [default: plasma from yellow to violet, the strongest]
    #[arg(long, value_name = "NAME", value_parser = map, requires = "flow", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow_colormap: Option<String>,
    /// Draw lines without the volume
    #[arg(long, help_heading = HEADING)]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub hide_volume: bool,
}

const HEADING: &str = "Lines";

/// A line is no thinner, else pixels miss it.
const THINNEST_PIXELS: f64 = 1.2;

fn width(text: &str) -> Result<f64, String> {
    let number = text.parse().ok();
    let number = number.filter(|n: &f64| (THINNEST_PIXELS..=1000.0).contains(n));
    number.ok_or_else(|| {
        format!("wanted {THINNEST_PIXELS} to 1000 pixels: a thinner line is missed by pixels, found {text}")
    })
}

fn map(text: &str) -> Result<String, String> {
    match Colormap::from_name(text) {
        Some(_) => Ok(text.to_owned()),
        None => Err(
            "wanted the name of a colour map: `stratavox render --help` lists them at --colormap"
                .to_owned(),
        ),
    }
}
