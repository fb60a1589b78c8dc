//! A number of f64 and how far any device of Vulkan may be from it: running error analysis (Wilkinson 1963; Higham,
//! "Accuracy and Stability of Numerical Algorithms", 2002, section 3.3), operation by operation.
//!
//! ```text
//! |device - value| <= error        eps = 2^-23: correctly rounded is one of the two nearest (Vulkan specification,
//!                                  "Precision and Operation of SPIR-V Instructions"), which the other table follows
//! + - *      eps                    /         5/2 eps            sqrt      5 eps (1 / inverseSqrt, and a division)
//! exp x      (3 + 2 |x|) eps        ln        2^-21 between 1/2 and 2, 3 eps of it elsewhere
//! x^y        exp2(y log2 x)         mix       x (1 - a) + y a, whose four roundings are not those of x + a (y - x)
//! ```
//!
//! What a device contracts has a rounding less. Where an operation's result is a number of f32 and its operands are
//! exact, so is it. A comparison or a `floor` whose outcome lies inside of the error sets a mark, and all numbers of
//! the pixel that come after are infinitely uncertain: the answer depends on rounding. A minimum and a maximum do not:
//! they are as continuous as their operands.
//!
//! The CPU references that are written for [`Real`] run with it as they are. [`Real::to_f32`] gives the error, rounded up: a
//! picture of these numbers is a picture of what is allowed.

mod blended;

use crate::real::Real;
use std::cell::Cell;
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The distance of 1 from the next f32: an operation may round either way.
const EPS: f64 = 1.0 / (1u32 << 23) as f64;
/// What log and log2 may be off by between 1/2 and 2.
const LOG: f64 = 1.0 / (1u32 << 21) as f64;
/// Smaller numbers may be flushed to zero.
const LEAST: f64 = f32::MIN_POSITIVE as f64;

thread_local! {
    static HANGS: Cell<bool> = const { Cell::new(false) };
}

/// A number and its uncertainty. `ROUNDED`: numbers that come as f32 are roundings of the true ones, which is what
/// the parameters of a picture are to a closed form of the camera; else they are exact, as they are to a CPU reference.
/// `F16`: slices are blended in 16-bit floats, by batches.
#[derive(Clone, Copy, Debug)]
pub struct Tracked<const ROUNDED: bool, const F16: bool> {
    value: f64,
    error: f64,
}

impl<const ROUNDED: bool, const F16: bool> Tracked<ROUNDED, F16> {
    fn exact(value: f64) -> Self {
        Self::with(value, 0.0)
    }

    fn with(value: f64, error: f64) -> Self {
        let hangs = HANGS.get() || error.is_nan();
        Self {
            value,
            error: if hangs { f64::INFINITY } else { error },
        }
    }

    /// The result of an operation whose operands make it off by `carried`, and which is off by `own` of it itself.
    fn rounded(value: f64, carried: f64, own: f64) -> Self {
        let is_tiny = value != 0.0 && value.abs() < LEAST;
        let flushed = if is_tiny { LEAST } else { 0.0 };
        Self::with(value, carried + times(value.abs() + carried, own) + flushed)
    }

    /// The same of an operation that gives back what f32 holds.
    fn correctly_rounded(value: f64, carried: f64) -> Self {
        match carried == 0.0 && f64::from(value as f32) == value {
            true => Self::exact(value),
            false => Self::rounded(value, carried, EPS),
        }
    }

    fn is_exactly(&self, number: f64) -> bool {
        self.value == number && self.error == 0.0
    }

    /// The whole number that `of` makes of this.
    fn whole(self, of: impl Fn(f64) -> f64) -> Self {
        if of(self.value - self.error) != of(self.value + self.error) {
            HANGS.set(true);
        }
        Self::exact(of(self.value))
    }

    /// How this stands to another, and the mark where that is not sure.
    fn compare(&self, other: &Self) -> Option<Ordering> {
        let is_same = self.value == other.value && self.error == other.error;
        let uncertain = self.error + other.error;
        let is_near = (self.value - other.value).abs() <= uncertain;
        if !is_same && uncertain > 0.0 && is_near {
            HANGS.set(true);
        }
        self.value.partial_cmp(&other.value)
    }

    /// `pick` is one of the two, and where they cannot be told apart it is as uncertain as either.
    fn either(self, other: Self, pick: Self) -> Self {
        let uncertain = self.error + other.error;
        let is_near = (self.value - other.value).abs() <= uncertain;
        let error = match is_near {
            true => self.error.max(other.error),
            false => pick.error,
        };
        Self::with(pick.value, error)
    }

    /// The most that this, exact, comes to by a positive power.
    fn most_to(self, y: Self) -> f64 {
        let log = self.value.log2();
        if log == f64::NEG_INFINITY {
            return 0.0;
        }
        let power = y.value * log;
        let off = y.value * self.of_log(log) + y.error * log.abs() + EPS * power.abs();
        let own = (3.0 + 2.0 * (power.abs() + off)) * EPS;
        (power + off).exp2() * (1.0 + own) + LEAST
    }

    /// What a logarithm may be off by by itself, its argument being somewhere here.
    fn of_log(self, found: f64) -> f64 {
        let (low, high) = (self.value - self.error, self.value + self.error);
        let is_near_one = low <= 2.0 && high >= 0.5;
        (3.0 * EPS * found.abs()).max(if is_near_one { LOG } else { 0.0 })
    }
}

/// Nothing of anything is nothing.
fn times(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

impl<const R: bool, const F16: bool> PartialEq for Tracked<R, F16> {
    fn eq(&self, other: &Self) -> bool {
        self.compare(other) == Some(Ordering::Equal)
    }
}

impl<const R: bool, const F16: bool> PartialOrd for Tracked<R, F16> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.compare(other)
    }
}

impl<const R: bool, const F16: bool> Neg for Tracked<R, F16> {
    type Output = Self;
    fn neg(self) -> Self {
        Self::with(-self.value, self.error)
    }
}

impl<const R: bool, const F16: bool> Add for Tracked<R, F16> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        if other.is_exactly(0.0) {
            return self;
        }
        if self.is_exactly(0.0) {
            return other;
        }
        Self::correctly_rounded(self.value + other.value, self.error + other.error)
    }
}

impl<const R: bool, const F16: bool> Sub for Tracked<R, F16> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<const R: bool, const F16: bool> Mul for Tracked<R, F16> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        if other.is_exactly(1.0) {
            return self;
        }
        if self.is_exactly(1.0) {
            return other;
        }
        let carried = times(self.value.abs(), other.error)
            + times(other.value.abs(), self.error)
            + times(self.error, other.error);
        Self::correctly_rounded(self.value * other.value, carried)
    }
}

impl<const R: bool, const F16: bool> Div for Tracked<R, F16> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let least = other.value.abs() - other.error;
        let carried = match least > 0.0 {
            true => (self.error + times(value.abs(), other.error)) / least,
            false if self.is_exactly(0.0) => 0.0,
            false => f64::INFINITY,
        };
        Self::rounded(value, carried, 2.5 * EPS)
    }
}

impl<const R: bool, const F16: bool> Real for Tracked<R, F16> {
    fn from_f64(x: f64) -> Self {
        let stored = f64::from(x as f32);
        match stored == x {
            true => Self::with(x, 0.0),
            false => Self::with(x, (stored - x).abs()),
        }
    }

    fn from_f32(x: f32) -> Self {
        let error = match R && x.is_finite() {
            true => 0.5 * EPS * f64::from(x.abs()),
            false => 0.0,
        };
        Self::with(x.into(), error)
    }

    fn to_f64(self) -> f64 {
        self.value
    }

    fn to_f32(self) -> f32 {
        match self.error == 0.0 {
            true => 0.0,
            false => (self.error as f32).next_up(),
        }
    }

    fn to_i32(self) -> i32 {
        self.whole(f64::trunc).value as i32
    }

    fn floor(self) -> Self {
        self.whole(f64::floor)
    }

    fn ceil(self) -> Self {
        self.whole(f64::ceil)
    }

    fn round(self) -> Self {
        self.whole(f64::round_ties_even)
    }

    fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        let low = (self.value - self.error).max(0.0).sqrt();
        let carried = match value + low > 0.0 {
            true => self.error / (value + low),
            false => self.error.sqrt(),
        };
        Self::rounded(value, carried, 5.0 * EPS)
    }

    fn exp(self) -> Self {
        let value = self.value.exp();
        let carried = times(value, self.error.exp_m1());
        let own = (3.0 + 2.0 * (self.value.abs() + self.error)) * EPS;
        Self::rounded(value, carried, own)
    }

    fn ln(self) -> Self {
        let value = self.value.ln();
        let carried = match self.error < self.value {
            true => -(-self.error / self.value).ln_1p(),
            false => f64::INFINITY,
        };
        Self::with(value, carried + self.of_log(value))
    }

    fn powf(self, y: Self) -> Self {
        let value = self.value.powf(y.value);
        let most = Self::exact(self.value + self.error).most_to(y);
        if self.value <= self.error {
            return Self::with(value, most);
        }
        let log = self.value.log2();
        let carried = self.error / (self.value - self.error) / std::f64::consts::LN_2;
        let log_error = carried + self.of_log(log);
        let power = y.value * log;
        let power_error = y.value.abs() * log_error
            + y.error * (log.abs() + log_error)
            + EPS * (power.abs() + y.value.abs() * log_error);
        let carried = value * (power_error * std::f64::consts::LN_2).exp_m1();
        let own = (3.0 + 2.0 * (power.abs() + power_error)) * EPS;
        let found = Self::rounded(value, carried, own);
        // Near zero the power is as uncertain as it is large, and no more.
        match y.value > y.error {
            true => Self::with(value, found.error.min(most)),
            false => found,
        }
    }

    fn abs(self) -> Self {
        Self::with(self.value.abs(), self.error)
    }

    fn min(self, other: Self) -> Self {
        let pick = match self.value.min(other.value) == self.value {
            true => self,
            false => other,
        };
        self.either(other, pick)
    }

    fn max(self, other: Self) -> Self {
        let pick = match self.value.max(other.value) == self.value {
            true => self,
            false => other,
        };
        self.either(other, pick)
    }

    fn lerp(self, other: Self, part: Self) -> Self {
        let value = self.value + part.value * (other.value - self.value);
        let (near, far) = ((1.0 - part.value).abs(), part.value.abs());
        let carried = times(self.error, near + part.error)
            + times(other.error, far + part.error)
            + times((other.value - self.value).abs(), part.error);
        let sizes = 2.0 * self.value.abs() * near + other.value.abs() * far;
        match part.is_exactly(0.0) {
            true => self,
            false => Self::rounded(value, carried + times(sizes, EPS), EPS),
        }
    }

    fn range(self) -> [f64; 2] {
        [self.value - self.error, self.value + self.error]
    }

    fn or(self, other: Self) -> Self {
        let apart = (self.value - other.value).abs();
        Self::with(self.value, self.error.max(apart + other.error))
    }

    const IS_MERGED: bool = F16;

    fn in_target(self) -> Self {
        self.kept()
    }

    fn over(self, behind: Self) -> Self {
        self.blended_over(behind)
    }

    fn begin() {
        HANGS.set(false);
    }

    fn ended(self) -> Self {
        Self::with(self.value, self.error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Number = Tracked<false, false>;

    #[test]
    fn what_f32_makes_of_a_sum_lies_inside_of_the_error() {
        let mut state = 1u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / 16_777_216.0
        };
        let mut widest = 0.0f64;
        for _ in 0..2000 {
            let numbers: [f32; 6] = std::array::from_fn(|_| next() + 0.01);
            fn made<R: Real>([a, b, c, d, e, f]: [R; 6]) -> R {
                let sum = (a * b - c).abs().sqrt() / d + (-e).exp() * f.ln();
                a.lerp(sum, c).max(b.powf(d)) - e
            }
            Number::begin();
            let tracked = made(numbers.map(Number::from_f32));
            let single = made(numbers);
            let off = (f64::from(single) - tracked.value).abs();
            assert!(off <= tracked.error, "{numbers:?}: {off}, {tracked:?}");
            widest = widest.max(off / tracked.error);
        }
        assert!(widest > 0.01, "errors are no bounds but {widest} of them");
    }

    #[test]
    fn a_power_of_nearly_nothing_is_nearly_nothing() {
        for part in [0.5, 0.99, 1.0 - 1e-12, 1.0, 2.0, 1e6] {
            Number::begin();
            let base = Number::with(1e-3, 1e-3 * part);
            let found = base.powf(Number::from_f64(23.0));
            let largest = (base.value + base.error).powi(23);
            assert!(found.error >= largest - found.value, "{part}: {found:?}");
            assert!(found.error <= 1.001 * largest + LEAST, "{part}: {found:?}");
        }
    }

    #[test]
    fn a_comparison_inside_of_the_error_leaves_a_mark_until_the_next_pixel() {
        Number::begin();
        let third = Number::from_f64(1.0) / Number::from_f64(3.0);
        let whole = third + third + third;
        assert!(third < whole);
        assert!(whole.error.is_finite() && whole.error > 0.0);
        let _ = whole.floor();
        assert_eq!(third.ended().error, f64::INFINITY);
        Number::begin();
        assert!(third.ended().error < 1e-6);
        let one = Number::from_f64(1.0);
        assert!((one + one) * one == Number::from_f64(2.0), "exact");
        assert_eq!(one.ended().error, 0.0);
    }
}
