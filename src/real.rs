//! f32 or f64: the CPU references are written once for both, f32 to prove a shader and f64 to prove the mathematics. A third
//! kind knows how far off a device may be (`conformance::oracle::Tracked`).
//!
//! A number does what it does in WGSL, one rounding an operation: no fused multiply-add, and `round`
//! goes to the even neighbor on a tie.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// An f32, an f64, or a number that behaves as one.
pub trait Real:
    Copy
    + Debug
    + PartialOrd
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + 'static
{
    /// The nearest number of this type.
    fn from_f64(x: f64) -> Self;
    /// Exact.
    fn from_f32(x: f32) -> Self;
    /// Exact.
    fn to_f64(self) -> f64;
    /// The nearest f32.
    fn to_f32(self) -> f32;
    /// Toward zero, to the nearest end where it does not fit, 0 for a NaN.
    fn to_i32(self) -> i32;
    /// The largest whole number that is not above.
    fn floor(self) -> Self;
    /// The smallest whole number that is not below.
    fn ceil(self) -> Self;
    /// The nearest whole number, the even one of two.
    fn round(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// e to this power.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// This to the power `y`.
    fn powf(self, y: Self) -> Self;
    /// Without its sign.
    fn abs(self) -> Self;
    /// The smaller; the one that is a number where the other is not.
    fn min(self, other: Self) -> Self;
    /// The larger; the one that is a number where the other is not.
    fn max(self, other: Self) -> Self;
    /// From this to `other`, so much of the way.
    fn lerp(self, other: Self, part: Self) -> Self {
        self + part * (other - self)
    }
    /// The least and the most that this may be.
    fn range(self) -> [f64; 2] {
        [self.to_f64(); 2]
    }
    /// This, where `other` may as well be what a device has.
    fn or(self, _other: Self) -> Self {
        self
    }
    /// Whether slices are blended in a target that keeps less than this type does, and merged by batches
    /// ([`technique::merge`](crate::technique::merge)).
    const IS_MERGED: bool = false;
    /// As the target that slices are blended in keeps it.
    fn in_target(self) -> Self {
        self
    }
    /// What a target whose alpha this is keeps of the alpha of both, it and one behind it.
    fn over(self, behind: Self) -> Self {
        let left = (Self::from_f64(1.0) - self).in_target();
        ((left * behind).in_target() + self).in_target()
    }
    /// A pixel begins: numbers that keep what has become of them forget it.
    fn begin() {}
    /// The same number at the end of its pixel, with what has become of it.
    fn ended(self) -> Self {
        self
    }
}

macro_rules! real {
    ($real:ident) => {
        impl Real for $real {
            fn from_f64(x: f64) -> Self {
                x as $real
            }
            fn from_f32(x: f32) -> Self {
                $real::from(x)
            }
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            fn to_f32(self) -> f32 {
                self as f32
            }
            fn to_i32(self) -> i32 {
                self as i32
            }
            fn floor(self) -> Self {
                $real::floor(self)
            }
            fn ceil(self) -> Self {
                $real::ceil(self)
            }
            fn round(self) -> Self {
                $real::round_ties_even(self)
            }
            fn sqrt(self) -> Self {
                $real::sqrt(self)
            }
            fn exp(self) -> Self {
                $real::exp(self)
            }
            fn ln(self) -> Self {
                $real::ln(self)
            }
            fn powf(self, y: Self) -> Self {
                $real::powf(self, y)
            }
            fn abs(self) -> Self {
                $real::abs(self)
            }
            fn min(self, other: Self) -> Self {
                $real::min(self, other)
            }
            fn max(self, other: Self) -> Self {
                $real::max(self, other)
            }
        }
    };
}

real!(f32);
real!(f64);

/// a·b
pub fn dot<R: Real>(a: [R; 3], b: [R; 3]) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a + b
pub fn add<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// a - b
pub fn sub<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// a times s
pub fn scale<R: Real>(a: [R; 3], s: R) -> [R; 3] {
    [a[0] * s, a[1] * s, a[2] * s]
}
