//! What a blending unit rounds. In 16-bit floats source, factor, product and sum are each such a number: off by 2^-10 of
//! it, because it may be cut off (Vulkan specification, "Blending": "a precision and dynamic range no lower than that
//! used to represent destination components"), and under 2^-14 by all of it, because it may be flushed to zero.

use super::{EPS, LEAST, Tracked};

/// The distance of 1 from the next 16-bit float, and the least one that has all its digits.
const EPS_F16: f64 = 1.0 / 1024.0;
const LEAST_F16: f64 = 1.0 / 16_384.0;

impl<const ROUNDED: bool, const F16: bool> Tracked<ROUNDED, F16> {
    /// A 16-bit float, for sure.
    fn is_f16(self) -> bool {
        const DIGITS: u64 = (1 << (f64::MANTISSA_DIGITS - 11)) - 1;
        let has_digits = self.value.to_bits() & DIGITS == 0 && self.value.abs() >= LEAST_F16;
        self.error == 0.0 && (self.value == 0.0 || has_digits)
    }

    /// As the target keeps it.
    pub(super) fn kept(self) -> Self {
        if !F16 || self.is_f16() {
            return self;
        }
        let (least, most) = (self.value.abs() - self.error, self.value.abs() + self.error);
        let flushed = if least < LEAST_F16 {
            most.min(LEAST_F16)
        } else {
            0.0
        };
        Self::with(self.value, self.error + EPS_F16 * most + flushed)
    }

    /// The alpha of both, this one nearer. What it is off by stands in both terms: one takes back of the other as much as
    /// is behind.
    pub(super) fn blended_over(self, behind: Self) -> Self {
        if behind.is_exactly(0.0) || self.is_exactly(0.0) {
            return self + behind;
        }
        let left = (1.0 - self.value).abs();
        let value = self.value + (1.0 - self.value) * behind.value;
        let carried =
            self.error * ((1.0 - behind.value).abs() + behind.error) + behind.error * left;
        let product = (left + self.error) * (behind.value.abs() + behind.error);
        let (eps, least) = if F16 {
            (EPS_F16, LEAST_F16)
        } else {
            (EPS, LEAST)
        };
        // Of the factor, of the product, and of the sum of what these make of it.
        let sum = self.value.abs() + self.error + product;
        let rounded = eps * (2.0 * product + sum) * (1.0 + 2.0 * eps);
        let low = (left - self.error) * (behind.value.abs() - behind.error);
        let flushed = if low < least {
            2.0 * product.min(least) + sum.min(least)
        } else {
            0.0
        };
        Self::with(value, carried + rounded + flushed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::real::Real;
    use crate::technique::Order;
    use crate::technique::blend::blend_material;

    /// The 16-bit float next to zero from here, of as many digits however small.
    fn cut_off(number: f32) -> f32 {
        f32::from_bits(number.to_bits() & !0x1fff)
    }

    #[test]
    fn what_cut_off_blends_make_of_many_slices_lies_inside_of_the_error() {
        type Blended = Tracked<false, true>;
        let mut state = 1u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / 16_777_216.0
        };
        let mut widest = 0.0f64;
        for slices in [1, 8, 64] {
            for order in [Order::BackToFront, Order::FrontToBack] {
                Blended::begin();
                let (mut cut, mut tracked) = ([0.0f32; 4], [Blended::from_f64(0.0); 4]);
                for _ in 0..slices {
                    let [r, g, b, extinction] = [next(), next(), next(), 0.2 * next()];
                    let material = [r, g, b, extinction].map(Blended::from_f32);
                    tracked = blend_material(order, tracked, material, Blended::from_f64(1.0));
                    let opacity = cut_off(-(-extinction).exp_m1());
                    let source = [r, g, b].map(|c| cut_off(opacity * c));
                    let source = [source[0], source[1], source[2], opacity];
                    let nearer = if order == Order::BackToFront {
                        opacity
                    } else {
                        cut[3]
                    };
                    let left = cut_off(1.0 - nearer);
                    cut = std::array::from_fn(|c| match order {
                        Order::BackToFront => cut_off(source[c] + cut_off(left * cut[c])),
                        Order::FrontToBack => cut_off(cut_off(left * source[c]) + cut[c]),
                    });
                }
                for (cut, tracked) in cut.into_iter().zip(tracked) {
                    let off = (f64::from(cut) - tracked.value).abs();
                    assert!(
                        off <= tracked.error,
                        "{slices} {order:?}: {off}, {tracked:?}"
                    );
                    assert!(tracked.error < 0.1, "{slices} {order:?}: {tracked:?}");
                    widest = widest.max(off / tracked.error);
                }
            }
        }
        assert!(widest > 0.3, "errors are no bounds but {widest} of them");
    }
}
