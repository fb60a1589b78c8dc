//! A background behind a picture: `C + (1 - A) background`, in the space that the picture was blended in.

use super::{ColorSpace, Picture};
use crate::color::decode_srgb;

impl Picture {
    /// Puts `[red, green, blue, alpha]`, sRGB numbers and a straight alpha from 0 to 1, behind every pixel.
    ///
    /// Layers stay: transmittance is that before the background.
    pub fn over_background(&mut self, srgb: [f64; 4]) {
        let [r, g, b, alpha] = srgb;
        let color = match self.color_space {
            ColorSpace::Linear => [r, g, b].map(decode_srgb),
            ColorSpace::Display => [r, g, b],
        };
        let behind = [color[0] * alpha, color[1] * alpha, color[2] * alpha, alpha];
        for pixel in &mut self.pixels {
            let left = 1.0 - f64::from(pixel[3]);
            for (c, number) in pixel.iter_mut().enumerate() {
                *number = (f64::from(*number) + left * behind[c]) as f32;
            }
        }
    }
}
