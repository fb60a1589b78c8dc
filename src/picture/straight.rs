//! Premultiplied numbers to what files hold (`sampling.md` 8).
//!
//! ```text
//! PNG       c = C/A (0 where A = 0), clamped, encoded unless it is an sRGB number already;
//!           code = floor(c max + 1/2); alpha is linear A
//! floats    linear premultiplied; sRGB numbers are divided by A, decoded, and multiplied again
//! ```

use super::srgb_codes::SrgbCodes;
use super::{ColorSpace, Picture};
use crate::color::{decode_srgb, encode_srgb};
use std::num::NonZero;

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
        self.codes_as(max, |code| code)
    }

    /// The same, each kept as `kept` makes it. Rows are shared out to threads.
    pub(super) fn codes_as<T: Clone + Default + Send>(
        &self,
        max: u16,
        kept: impl Fn(u16) -> T + Sync,
    ) -> Vec<[T; 4]> {
        let (table, space) = (SrgbCodes::shared(), self.color_space);
        let straight = |pixel| codes_of(pixel, space, max, table).map(&kept);
        let mut codes = vec![<[T; 4]>::default(); self.pixels.len()];
        let threads = std::thread::available_parallelism().map_or(1, NonZero::get);
        let share = self.pixels.len().div_ceil(threads).max(LEAST_PIXELS);
        let work = |codes: &mut [[T; 4]], pixels: &[[f32; 4]]| {
            for (code, pixel) in codes.iter_mut().zip(pixels) {
                *code = straight(*pixel);
            }
        };
        let mut shares = codes.chunks_mut(share).zip(self.pixels.chunks(share));
        std::thread::scope(|scope| {
            let own = shares.next();
            for (codes, pixels) in shares {
                scope.spawn(move || work(codes, pixels));
            }
            if let Some((codes, pixels)) = own {
                work(codes, pixels);
            }
        });
        codes
    }
}

/// Fewer are not worth a thread.
const LEAST_PIXELS: usize = 1 << 14;

/// [`straight_srgb`] in codes.
fn codes_of(pixel: [f32; 4], space: ColorSpace, max: u16, table: &SrgbCodes) -> [u16; 4] {
    // Most of many pictures.
    if pixel == [0.0; 4] {
        return [0; 4];
    }
    // What is cut off is what `floor` takes: nothing here is below zero.
    let rounded = |x: f64| (x * f64::from(max) + 0.5) as u16;
    let [r, g, b, alpha] = straight(pixel);
    let [r, g, b] = [r, g, b].map(|c| match space {
        ColorSpace::Linear => table.code(c, max),
        ColorSpace::Display => rounded(c),
    });
    [r, g, b, rounded(alpha)]
}

/// sRGB numbers divided by alpha, and alpha, all from 0 to 1; what is not a number counts as 0.
pub(super) fn straight_srgb(pixel: [f32; 4], space: ColorSpace) -> [f64; 4] {
    let [r, g, b, alpha] = straight(pixel);
    let [r, g, b] = [r, g, b].map(|c| match space {
        ColorSpace::Linear => encode_srgb(c),
        ColorSpace::Display => c,
    });
    [r, g, b, alpha]
}

/// Divided by alpha, and alpha, all from 0 to 1.
fn straight(pixel: [f32; 4]) -> [f64; 4] {
    let [r, g, b, alpha] = pixel.map(f64::from);
    let [r, g, b] = [r, g, b].map(|c| fraction(if alpha == 0.0 { 0.0 } else { c / alpha }));
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
