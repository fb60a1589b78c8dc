//! sRGB numbers and linear light, IEC 61966-2-1:1999.
//!
//! ```text
//! linear = s / 12.92                     s <= 0.04045
//!          ((s + 0.055) / 1.055)^2.4     above
//! s      = 12.92 linear                  linear <= 0.0031308
//!          1.055 linear^(1/2.4) - 0.055  above
//! ```

use crate::named::named;
use crate::real::Real;

/// In which numbers colours are blended and kept (`sampling.md` 4 and 8).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorSpace {
    /// Linear light.
    #[default]
    Linear,
    /// sRGB numbers blended as they are, as VTK and Slicer do.
    Display,
}

named!(ColorSpace {
    Linear "linear" "",
    Display "display" "",
});

/// Linear light of an sRGB number.
pub fn decode_srgb<N: Real>(srgb: N) -> N {
    let n = N::from_f64;
    if srgb <= n(0.04045) {
        srgb / n(12.92)
    } else {
        ((srgb + n(0.055)) / n(1.055)).powf(n(2.4))
    }
}

/// The sRGB number of linear light.
pub fn encode_srgb<N: Real>(linear: N) -> N {
    let n = N::from_f64;
    if linear <= n(0.0031308) {
        linear * n(12.92)
    } else {
        n(1.055) * linear.powf(n(1.0 / 2.4)) - n(0.055)
    }
}
