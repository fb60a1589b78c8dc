//! How large the picture is, what lies behind the volume, and which layers go with it.

use super::numbers::stops;
use super::{Background, Error, Size};
use crate::picture::{BitDepth, LayerKind, Tone, ToneCurve};
use clap::{Args, ValueEnum};
use serde::{Deserialize, Serialize};

/// The flags, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PictureFlags {
    /// Pixels across and down [default: 1024x768]
    #[arg(long, value_name = "WxH", help_heading = "Picture")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size: Option<Size>,
    /// What lies behind: a colour by name, #hex or sRGB numbers from 0 to 1; environment: the light of --environment
    /// [default: #18181c in PNG and
    /// films under --look auto, else none]
    #[arg(long, value_name = "COLOR|none|environment", help_heading = "Picture")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub background: Option<Background>,
    /// Layers beside the colours, for .exr and .npy; of --technique pathtrace means over the paths of a pixel, with their noise
    #[arg(
        long,
        value_name = "NAME,...",
        value_delimiter = ',',
        help_heading = "Picture"
    )]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub aov: Vec<LayerWord>,
    /// Bits of a channel of a PNG or APNG [default: 8]
    #[arg(long, value_name = "8|16", value_parser = bits_of, help_heading = "Picture")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bit_depth: Option<Bits>,
    /// Stops of light: colours of PNG and films are multiplied by 2 to this power before they are coded [default: 0; 1 under --look cinematic]
    #[arg(long, value_name = "EV", value_parser = stops, allow_hyphen_values = true, help_heading = "Picture")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exposure: Option<f64>,
    /// What PNG and films do with light near white and over it [default: none; neutral under --look cinematic]
    #[arg(long, value_enum, value_name = "CURVE", help_heading = "Picture")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tone: Option<ToneWord>,
}

/// Every word of `--tone`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ToneWord {
    /// Cut off: every technique shows the same colours
    None,
    /// Colours stay, and bright ones fade to white (Khronos PBR neutral)
    Neutral,
    /// Soft in the dark and in the light (Hable)
    Filmic,
}

/// Bits of a channel; a scene file has them as a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "u8", into = "u8")]
pub struct Bits(BitDepth);

impl TryFrom<u8> for Bits {
    type Error = &'static str;

    fn try_from(bits: u8) -> Result<Self, &'static str> {
        match bits {
            8 => Ok(Self(BitDepth::Eight)),
            16 => Ok(Self(BitDepth::Sixteen)),
            _ => Err("wanted 8 or 16 bits of a channel"),
        }
    }
}

impl From<Bits> for u8 {
    fn from(Bits(depth): Bits) -> Self {
        match depth {
            BitDepth::Eight => 8,
            BitDepth::Sixteen => 16,
        }
    }
}

/// Reads the word of `--bit-depth`.
fn bits_of(word: &str) -> Result<Bits, String> {
    let bits = word
        .parse::<u8>()
        .ok()
        .and_then(|bits| bits.try_into().ok());
    bits.ok_or_else(|| "wanted 8 or 16".to_owned())
}

/// Pixels on one side: what image formats and devices agree on.
const MAX_SIDE_PIXELS: u32 = 32_768;

impl PictureFlags {
    /// Pixels across and down.
    pub fn extent_pixels(&self) -> Result<[u32; 2], Error> {
        let Size(extent) = self.size.unwrap_or(Size([1024, 768]));
        if extent.iter().any(|&side| side > MAX_SIDE_PIXELS) {
            return Err(Error::TooMany {
                message: format!(
                    "--size {}x{}: a side has at most {MAX_SIDE_PIXELS} pixels",
                    extent[0], extent[1]
                ),
                hint: "--size 3840x2160 fills a large screen, --size 10000x7000 a page at 600 dots per inch",
            });
        }
        Ok(extent)
    }

    /// Straight sRGB and alpha of what lies behind; `None`: nothing does.
    pub fn background(&self) -> Option<[f64; 4]> {
        match self.background {
            Some(Background::Color(color)) => Some(color),
            Some(Background::None | Background::Environment) | None => None,
        }
    }

    /// What PNG and films are sent through.
    pub fn tone(&self) -> Tone {
        Tone {
            exposure: self.exposure.unwrap_or(0.0),
            curve: match self.tone {
                None | Some(ToneWord::None) => ToneCurve::None,
                Some(ToneWord::Neutral) => ToneCurve::Neutral,
                Some(ToneWord::Filmic) => ToneCurve::Filmic,
            },
        }
    }

    /// Bits of a channel of a PNG.
    pub fn bit_depth(&self) -> BitDepth {
        self.bit_depth.map_or(BitDepth::Eight, |Bits(depth)| depth)
    }

    /// Whether the light of `--environment` lies behind.
    pub fn shows_sky(&self) -> bool {
        self.background == Some(Background::Environment)
    }

    /// The layers asked for, each once, in the order of the words.
    pub fn layers(&self) -> Vec<LayerKind> {
        let mut layers = Vec::new();
        for word in &self.aov {
            let layer = word.layer();
            if !layers.contains(&layer) {
                layers.push(layer);
            }
        }
        layers
    }
}

/// Every word of `--aov`, built or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs, reason = "the names say it")]
pub enum LayerWord {
    Value,
    Depth,
    Transmittance,
    Samples,
    /// The label at the depth
    Label,
    /// World position at the depth, three numbers a pixel
    Position,
    /// Unit normal at the depth, in the world towards lower values, three numbers a pixel
    Normal,
    /// The number of the line of --flow that is seen, counted from 1 as seeds are; 0 none
    Line,
    /// The standard error of luminance of --technique pathtrace
    Noise,
    /// The albedo of the first collision of --technique pathtrace
    Albedo,
    /// Light of --technique pathtrace that was scattered once
    Direct,
    /// Light of --technique pathtrace that was scattered more often
    Indirect,
    /// Light of --technique pathtrace that matter sends out and nothing scatters
    Emission,
    /// How often paths of --technique pathtrace are scattered
    Bounces,
}

impl LayerWord {
    fn layer(self) -> LayerKind {
        match self {
            Self::Value => LayerKind::Value,
            Self::Depth => LayerKind::Depth,
            Self::Transmittance => LayerKind::Transmittance,
            Self::Samples => LayerKind::Samples,
            Self::Position => LayerKind::Position,
            Self::Normal => LayerKind::Normal,
            Self::Label => LayerKind::Label,
            Self::Line => LayerKind::Line,
            Self::Noise => LayerKind::Noise,
            Self::Albedo => LayerKind::Albedo,
            Self::Direct => LayerKind::Direct,
            Self::Indirect => LayerKind::Indirect,
            Self::Emission => LayerKind::Emission,
            Self::Bounces => LayerKind::Bounces,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_layer_asked_for_twice_is_made_once() {
        let flags = PictureFlags {
            aov: vec![LayerWord::Depth, LayerWord::Value, LayerWord::Depth],
            ..PictureFlags::default()
        };
        assert_eq!(flags.layers(), [LayerKind::Depth, LayerKind::Value]);
    }

    #[test]
    fn a_picture_beyond_the_limit_is_refused_with_the_code_of_limits() {
        let flags = PictureFlags {
            size: Some(Size([32_769, 1])),
            ..PictureFlags::default()
        };
        assert_eq!(flags.extent_pixels().expect_err("refused").exit_code(), 6);
    }
}
