//! sRGB numbers and linear light, IEC 61966-2-1:1999.
//!
//! ```text
//! linear = s / 12.92                     s <= 0.04045
//!          ((s + 0.055) / 1.055)^2.4     above
//! s      = 12.92 linear                  linear <= 0.0031308
//!          1.055 linear^(1/2.4) - 0.055  above
//! ```

use std::ops::{Add, Div, Mul, Neg, Sub};

/// In which numbers colours are blended and kept (`sampling.md` 4 and 8).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorSpace {
    /// Linear light.
    #[default]
    Linear,
    /// sRGB numbers blended as they are, as VTK and Slicer do.
    Display,
}

/// Linear light of an sRGB number.
pub fn decode_srgb<N: Number>(srgb: N) -> N {
    let n = N::from_f64;
    if srgb <= n(0.04045) {
        srgb / n(12.92)
    } else {
        ((srgb + n(0.055)) / n(1.055)).powf(n(2.4))
    }
}

/// The sRGB number of linear light.
pub fn encode_srgb<N: Number>(linear: N) -> N {
    let n = N::from_f64;
    if linear <= n(0.0031308) {
        linear * n(12.92)
    } else {
        n(1.055) * linear.powf(n(1.0 / 2.4)) - n(0.055)
    }
}

/// f32 or f64.
pub trait Number:
    Copy
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The nearest number of this type.
    fn from_f64(x: f64) -> Self;
    /// This number, exactly.
    fn to_f64(self) -> f64;
    /// e to the power of this.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// This to the power of `exponent`.
    fn powf(self, exponent: Self) -> Self;
    /// The largest whole number that is not above this.
    fn floor(self) -> Self;
}

macro_rules! number {
    ($t:ty) => {
        impl Number for $t {
            fn from_f64(x: f64) -> Self {
                x as $t
            }
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            fn exp(self) -> Self {
                self.exp()
            }
            fn ln(self) -> Self {
                self.ln()
            }
            fn powf(self, exponent: Self) -> Self {
                self.powf(exponent)
            }
            fn floor(self) -> Self {
                self.floor()
            }
        }
    };
}
number!(f32);
number!(f64);
