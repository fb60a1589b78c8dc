//! sRGB codes of light without a power for each number, and the same codes.
//!
//! ```text
//! code(x) = floor(max s(x) + 1/2),   s as in `color`
//! ```
//!
//! s is taken straight between points that lie 1/1024 of an octave apart. It is concave there, so what lies between
//! two points is too low by at most
//!
//! ```text
//! h^2/8 |s''| = (2^-10 x)^2/8 1.055 (1/2.4) (1 - 1/2.4) x^(1/2.4 - 2) <= 3.1e-8        x <= 1
//! ```
//!
//! Only where that could make another code of it, one number of two hundred with 16 bits, the power itself is taken.

use crate::color::encode_srgb;
use std::sync::OnceLock;

/// Bits of a number's fraction that say between which points it lies.
const POINT_BITS: u32 = 10;

/// More than what lies between two points is off, with what rounding adds.
const ERROR: f64 = 3.2e-8;

/// Below it sRGB numbers are a multiple of light.
const LINEAR: f64 = 0.003_130_8;

/// Points of s from [`LINEAR`] to 1.
#[derive(Debug)]
pub struct SrgbCodes {
    /// s, and by how much it rises with light from there to the next point.
    points: Vec<[f64; 2]>,
}

fn place(x: f64) -> usize {
    (x.to_bits() >> (f64::MANTISSA_DIGITS - 1 - POINT_BITS)) as usize
}

fn light_at(place: usize) -> f64 {
    f64::from_bits((place as u64) << (f64::MANTISSA_DIGITS - 1 - POINT_BITS))
}

impl SrgbCodes {
    /// The same for everybody.
    pub fn shared() -> &'static Self {
        static MADE: OnceLock<SrgbCodes> = OnceLock::new();
        MADE.get_or_init(|| {
            // Not `encode_srgb`: the first point may lie where that is linear.
            let s = |x: f64| 1.055 * x.powf(1.0 / 2.4) - 0.055;
            let point = |place| {
                let [x, next] = [place, place + 1].map(light_at);
                [s(x), (s(next) - s(x)) / (next - x)]
            };
            let points = (place(LINEAR)..=place(1.0)).map(point).collect();
            Self { points }
        })
    }

    /// The code of light from 0 to 1.
    pub fn code(&self, x: f64, max: u16) -> u16 {
        let max = f64::from(max);
        if x > LINEAR {
            let at = place(x);
            let [s, slope] = self.points[at - place(LINEAR)];
            let code = (s + slope * (x - light_at(at))) * max + 0.5;
            let [low, high] = [code - ERROR * max, code + ERROR * max].map(|code| code as u16);
            if low == high {
                return low;
            }
        }
        (encode_srgb(x) * max + 0.5).floor() as u16
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::decode_srgb;

    #[test]
    fn a_code_from_the_table_is_that_of_the_formula() {
        let codes = SrgbCodes::shared();
        let mut checked = 0_u32;
        let mut check = |x: f64, max: u16| {
            let wanted = (encode_srgb(x) * f64::from(max) + 0.5).floor() as u16;
            assert_eq!(codes.code(x, max), wanted, "{x:e} of {max}");
            checked += 1;
        };
        for max in [255, 65_535_u16] {
            // Beside every light at which the code changes, as near as numbers lie and as far as the table is off.
            for code in 1..=max {
                let edge = decode_srgb((f64::from(code) - 0.5) / f64::from(max));
                for off in [0.0, 1e-16, 1e-12, 1e-9, 1e-8, 5e-8, 1e-7] {
                    check(edge - off, max);
                    check((edge + off).min(1.0), max);
                }
            }
            for n in 0..=100_000 {
                check(f64::from(n) / 100_000.0, max);
            }
        }
        assert!(checked > 1_000_000);
    }
}
