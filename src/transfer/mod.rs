//! Value to colour and opacity.
//!
//! With opacity `a0` per reference length `d0`, linear between control points (`sampling.md` 4):
//!
//! ```text
//! sigma = -ln(1 - min(a0, 1 - 2^-12)) / d0        extinction, per world length
//! alpha = 1 - exp(-sigma d)                       opacity of a segment of length d
//! ```
//!
//! Colour is linear between its points in sRGB numbers and decoded afterwards.

mod automatic;
mod boundaries;
mod by_meaning;
mod channel;
mod colormap;
#[cfg(feature = "json")]
mod field;
#[cfg(feature = "json")]
mod file;
#[cfg(feature = "json")]
mod file_images;
#[cfg(feature = "json")]
mod file_medium;
#[cfg(feature = "json")]
mod file_widgets;
mod gradient_most;
mod gradient_transfer;
mod homogeneous_ranges;
#[cfg(all(feature = "json", feature = "files"))]
mod import;
#[cfg(feature = "json")]
mod labels;
mod law;
mod levels;
mod materials;
mod meaning;
mod medium;
mod parts;
mod points;
mod preset;
mod quantity;
mod slabs;
mod summary;
mod table;
mod visible_ranges;
mod widgets;
mod window;

pub use automatic::{Kind, automatic};
#[doc(hidden)]
pub use boundaries::{JointCounts, boundaries};
pub use by_meaning::{Choice, Context, LIT_LABEL_OPACITY, automatic_in};
#[cfg(feature = "cli")]
pub(crate) use channel::window_of_channel;
pub use channel::{CHANNEL_COLORS, of_channel, of_colors};
pub use colormap::{COLORMAP_COLORS, Colormap};
#[cfg(feature = "json")]
pub use file::{
    FileError, FileProblem, MAX_FILE_BYTES, MAX_POINTS, read_transfer_function,
    transfer_function_from_json, transfer_function_to_json,
};
pub use gradient_transfer::{Cells, GradientTransfer, SecondDerivative, Shape, Widget};
#[doc(hidden)]
pub use homogeneous_ranges::{HomogeneousRanges, Tolerance};
#[cfg(all(feature = "json", feature = "files"))]
pub use import::{Imported, Scale, import_transfer_function, transfer_function_from_bytes};
#[cfg(feature = "json")]
pub use labels::{Label, LabelTable};
pub use law::{Absorption, MAX_OPACITY, extinction, opacity_over};
pub use levels::{SURFACE_COLORS, Surface, surfaces};
pub use materials::{Material, TooMuch};
pub use meaning::{MEANINGS, Meaning, Scale as MeaningScale};
pub use medium::{MediumPoint, MediumTransfer, Phase};
#[doc(hidden)]
pub use points::{Points, classify_by_points, emission_by_points, extinctions_by_points};
pub use preset::Preset;
pub use quantity::Quantity;
#[doc(hidden)]
pub use slabs::{SlabCell, SlabTable, classify_slab};
#[doc(hidden)]
pub use summary::ValueSummary;
#[doc(hidden)]
pub use table::{MAX_ENTRIES, MIN_ENTRIES, Table, classify_by_table};
#[doc(hidden)]
pub use visible_ranges::{ContourReach, VisibleRanges};
#[doc(hidden)]
pub use widgets::{GradientMagnitude, PackedWidgets, classify_by_gradient};
pub use window::{Classified, Window};

/// A one-dimensional transfer function: colour and opacity have control points of their own.
#[derive(Clone, Debug, PartialEq)]
pub struct TransferFunction {
    /// By ascending value; constant beyond the ends; no point: black.
    pub color: Vec<ColorPoint>,
    /// By ascending value; constant beyond the ends; no point: transparent.
    pub opacity: Vec<OpacityPoint>,
    /// World length that opacities are for; `None`: the smallest voxel spacing.
    pub reference_length: Option<f64>,
    /// What lies between two points.
    pub interpolation: Interpolation,
    /// What the gradient makes of it; `None`: nothing.
    pub gradient_transfer: Option<GradientTransfer>,
    /// What techniques that scatter light take in place of colour and opacity; `None`: nothing else.
    pub medium: Option<Box<MediumTransfer>>,
}

/// sRGB colour at a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorPoint {
    /// After rescale.
    pub value: f64,
    /// sRGB numbers, 0 to 1.
    pub srgb: [f64; 3],
}

/// Opacity at a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpacityPoint {
    /// After rescale.
    pub value: f64,
    /// Per reference length, 0 to 1.
    pub opacity: f64,
}

/// What lies between two control points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// A straight line.
    #[default]
    Linear,
    /// The left point's value; at equal values the later point wins.
    Step,
}
