//! The picture of `--diff`.

use super::Comparison;
use crate::picture::{ColorSpace, Picture};

impl Comparison {
    /// Errors as greys: black where the pictures agree, white at the largest finite error, magenta where a
    /// number is missing in one of them. So it shows where, not how much: [`Comparison::max`] says that.
    pub fn picture(&self) -> Picture {
        let finite = self
            .errors
            .iter()
            .copied()
            .filter(|error| error.is_finite());
        let largest = finite.fold(0.0, f64::max);
        let pixel = |&error: &f64| {
            if !error.is_finite() {
                [1.0, 0.0, 1.0, 1.0]
            } else {
                let level = if largest > 0.0 { error / largest } else { 0.0 } as f32;
                [level, level, level, 1.0]
            }
        };
        Picture {
            width: self.width,
            height: self.height,
            pixels: self.errors.iter().map(pixel).collect(),
            color_space: ColorSpace::Display,
            layers: Vec::new(),
        }
    }
}
