//! Pictures as an eye sees them on a black background: sRGB numbers from 0 to 1.

use super::{Image, Numbers};
use crate::color::{decode_srgb, encode_srgb};
use crate::picture::straight::fraction;

/// Colours have no alpha in SSIM and FLIP. What is not a number counts as 0.
pub(super) fn over_black(image: &Image) -> Vec<[f64; 3]> {
    let pixels = image.pixels.iter();
    let pixels = pixels.map(|pixel| pixel.map(|x| fraction(x.into())));
    pixels
        .map(|[r, g, b, alpha]| {
            [r, g, b].map(|c| match image.numbers {
                Numbers::StraightSrgb if alpha == 1.0 => c,
                Numbers::StraightSrgb => encode_srgb(decode_srgb(c) * alpha),
                _ => encode_srgb(c),
            })
        })
        .collect()
}
