//! Premultiplied numbers to what files hold (`sampling.md` 8).
//!
//! ```text
//! PNG       c = C/A (0 where A = 0), clamped, encoded unless it is an sRGB number already;
//!           code = floor(c max + 1/2); alpha is linear A
//! floats    linear premultiplied; sRGB numbers are divided by A, decoded, and multiplied again
//! ```

use super::{ColorSpace, Picture};
use crate::color::{decode_srgb, encode_srgb};

impl Picture {
    /// Pixels as `.npy` and EXR hold them: linear light, premultiplied.
    pub fn linear_pixels(&self) -> Vec<[f32; 4]> {
        match self.color_space {
            ColorSpace::Linear => self.pixels.clone(),
            ColorSpace::Display => self.pixels.iter().map(|&p| linear_of_display(p)).collect(),
        }
    }

    /// Pixels as PNG holds them: straight sRGB numbers and alpha, `max` times, rounded.
    pub fn codes(&self, max: u16) -> Vec<[u16; 4]> {
        let code = |x: f64| (x * f64::from(max) + 0.5).floor() as u16;
        let pixels = self.pixels.iter();
        pixels
            .map(|&pixel| straight_srgb(pixel, self.color_space).map(code))
            .collect()
    }
}

/// sRGB numbers divided by alpha, and alpha, all from 0 to 1; what is not a number counts as 0.
pub(super) fn straight_srgb(pixel: [f32; 4], space: ColorSpace) -> [f64; 4] {
    let [r, g, b, alpha] = pixel.map(f64::from);
    let [r, g, b] = [r, g, b].map(|c| {
        let straight = fraction(if alpha == 0.0 { 0.0 } else { c / alpha });
        match space {
            ColorSpace::Linear => encode_srgb(straight),
            ColorSpace::Display => straight,
        }
    });
    [r, g, b, fraction(alpha)]
}

/// From 0 to 1; NaN becomes 0.
pub(super) fn fraction(x: f64) -> f64 {
    if x > 0.0 { x.min(1.0) } else { 0.0 }
}

fn linear_of_display(pixel: [f32; 4]) -> [f32; 4] {
    let [r, g, b, alpha] = pixel.map(f64::from);
    let light = [r, g, b].map(|c| match alpha {
        0.0 => 0.0,
        _ => (decode_srgb(c / alpha) * alpha) as f32,
    });
    [light[0], light[1], light[2], pixel[3]]
}
