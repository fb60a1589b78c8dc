//! A background behind a picture: `C + (1 - A) background`, in the space that the picture was blended in.

use super::{ColorSpace, Picture};
use crate::color::{decode_srgb, encode_srgb};

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

    /// Lays pixels of linear light, premultiplied, over these: `over + (1 - A) C`, in the space that the picture was
    /// blended in. As many as the picture has, rows from the top.
    ///
    /// Layers stay.
    pub fn lay_over(&mut self, over: &[[f32; 4]]) {
        for (pixel, &over) in self.pixels.iter_mut().zip(over) {
            let alpha = f64::from(over[3]);
            if alpha == 0.0 {
                continue;
            }
            let [r, g, b, a] = over.map(f64::from);
            let color = match self.color_space {
                ColorSpace::Linear => [r, g, b],
                ColorSpace::Display => [r, g, b].map(|c| encode_srgb(c / alpha) * alpha),
            };
            for (number, over) in pixel.iter_mut().zip([color[0], color[1], color[2], a]) {
                *number = (over + (1.0 - alpha) * f64::from(*number)) as f32;
            }
        }
    }
}
