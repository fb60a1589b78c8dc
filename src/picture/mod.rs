//! What a renderer gives: linear premultiplied colour, and layers beside it.

pub use crate::color::ColorSpace;

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
    /// `width * height` numbers, rows from the top; NaN where there is none.
    pub values: Vec<f32>,
}

/// The layers of `--aov`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LayerKind {
    /// What the mode projects, before classification.
    Value,
    /// World length along the ray to the first hit.
    Depth,
    /// 1 - alpha before the background.
    Transmittance,
    /// Samples taken.
    Samples,
}
