//! What a renderer gives: linear premultiplied colour, and layers beside it; files of both; and how far two
//! pictures are apart.

mod background;
#[doc(hidden)]
pub mod compare;
#[cfg(feature = "exr")]
mod exr;
#[cfg(feature = "png")]
mod hdr;
#[cfg(feature = "files")]
mod npy;
#[cfg(feature = "files")]
mod place;
#[cfg(feature = "png")]
mod png;
#[cfg(feature = "files")]
mod read;
mod srgb_codes;
mod straight;
mod tone;
#[cfg(feature = "files")]
mod write;

pub use crate::color::ColorSpace;
#[cfg(feature = "files")]
pub use place::OutputFile;
#[cfg(feature = "files")]
pub use read::{MAX_PICTURE_BYTES, PictureError, PictureProblem, read_image};
pub use tone::{Tone, ToneCurve};
#[cfg(feature = "files")]
pub use write::{
    BitDepth, EncodedPicture, OutputError, OutputProblem, PictureFormat, WriteOptions, write_file,
    write_picture,
};

/// A picture, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// (red, green, blue) times alpha, and alpha; linear light unless `color_space` says otherwise.
    pub pixels: Vec<[f32; 4]>,
    /// What the numbers in `pixels` are.
    pub color_space: ColorSpace,
    /// Further numbers for each pixel.
    pub layers: Vec<Layer>,
}

/// One kind of number for each pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Which.
    pub kind: LayerKind,
    /// `width * height` times as many numbers as the kind has, rows from the top, those of a pixel side by side;
    /// NaN where there is none.
    pub values: Vec<f32>,
}

/// The layers of `--aov`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LayerKind {
    /// What the mode projects, before classification.
    Value,
    /// World length along the ray to the first hit, of the volume or of what is drawn beside it; of paths the mean over those
    /// that meet something.
    Depth,
    /// 1 - alpha before the background.
    Transmittance,
    /// Samples taken; of paths the mean number of tentative collisions.
    Samples,
    /// World position of that hit: x, y, z.
    Position,
    /// Unit normal at the first hit: x, y, z in the world, towards lower values; NaN without a gradient. Of paths the mean of the
    /// normals of the surfaces that they meet first, towards the eye, 0 for those that meet none.
    Normal,
    /// The label at the first hit.
    Label,
    /// The number of the line that is seen, counted from 1 as seeds are; 0 where none is.
    Line,
    /// Path tracing: the standard error of luminance, linear; NaN where too few paths tell.
    Noise,
    /// Path tracing: the mean albedo of the first collision, linear; 0 for paths that meet nothing.
    Albedo,
    /// Path tracing: light that was scattered once, linear.
    Direct,
    /// Path tracing: light that was scattered more often, linear.
    Indirect,
    /// Path tracing: light that matter sends out and nothing scatters, linear.
    Emission,
    /// Path tracing: how often paths are scattered, the mean.
    Bounces,
    /// Marks that lie over the picture: linear light times opacity, and opacity. No renderer makes it.
    Annotation,
}

impl LayerKind {
    /// All that renderers make, in the order of `--aov`'s help.
    pub const ALL: [Self; 14] = [
        Self::Value,
        Self::Depth,
        Self::Transmittance,
        Self::Samples,
        Self::Position,
        Self::Normal,
        Self::Label,
        Self::Line,
        Self::Noise,
        Self::Albedo,
        Self::Direct,
        Self::Indirect,
        Self::Emission,
        Self::Bounces,
    ];

    /// The word of `--aov`, the name of the EXR channel, and the `NAME` of `OUT.NAME.npy`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Value => "value",
            Self::Depth => "depth",
            Self::Transmittance => "transmittance",
            Self::Samples => "samples",
            Self::Position => "position",
            Self::Normal => "normal",
            Self::Label => "label",
            Self::Line => "line",
            Self::Noise => "noise",
            Self::Albedo => "albedo",
            Self::Direct => "direct",
            Self::Indirect => "indirect",
            Self::Emission => "emission",
            Self::Bounces => "bounces",
            Self::Annotation => "annotation",
        }
    }

    /// Whether its numbers are linear red, green and blue.
    pub fn is_color(self) -> bool {
        matches!(
            self,
            Self::Albedo | Self::Direct | Self::Indirect | Self::Emission
        )
    }

    /// How many numbers a pixel has.
    pub fn numbers(self) -> usize {
        match self {
            Self::Position | Self::Normal => 3,
            _ if self.is_color() => 3,
            Self::Annotation => 4,
            _ => 1,
        }
    }
}
