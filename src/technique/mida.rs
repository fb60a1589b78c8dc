//! Emission and absorption in which a new maximum takes from what lies before it: CPU reference of
//! `shaders/lib/mode_mida.wgsl`.
//!
//! ```text
//! beta = 1 - max(u - m, 0) (1 + gamma)        u the value from 0 to 1, m the largest of those before
//! C = beta C + (1 - beta A) alpha c           A = beta A + (1 - beta A) alpha
//! gamma > 0       beta of gamma = 0; at the end of the ray, with c_M and a0_M of the maximum,
//!                 C = C + gamma (a0_M c_M - C)        A = A + gamma (a0_M - A)
//! ```
//!
//! Bruckner and Groeller, "Instant Volume Visualization using Maximum Intensity Difference Accumulation", Computer
//! Graphics Forum 28(3), 2009: from compositing at gamma = -1 by MIDA at 0 to MIP at 1, the second half by mixing
//! pictures.

use super::composite::Composite;
use super::per_mode::unit_from_value;
use crate::real::{Real, add, scale};
use crate::shaders::Frame;
use crate::transfer::opacity_over;

/// What a ray has gathered so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mida<R> {
    /// Colour, transmittance, and where opacity last reached one half.
    pub gathered: Composite<R>,
    /// The largest value so far, from 0 to 1.
    pub largest: R,
    /// The same value with its unit; none before the first.
    pub maximum: Option<R>,
}

impl<R: Real> Default for Mida<R> {
    fn default() -> Self {
        Self {
            gathered: Composite::default(),
            largest: R::from_f64(0.0),
            maximum: None,
        }
    }
}

impl<R: Real> Mida<R> {
    /// Adds a segment of `length` world length at `t`, of `value` and its material (red, green, blue, extinction).
    pub fn add(&mut self, frame: &Frame, value: R, [r, g, b, extinction]: [R; 4], length: R, t: R) {
        let (zero, half, one) = (R::from_f64(0.0), R::from_f64(0.5), R::from_f64(1.0));
        let opacity = opacity_over(extinction, length);
        let unit = unit_from_value(frame, value);
        let taken = (unit - self.largest).max(zero) * R::from_f32(frame.mida_fade);
        let before = &mut self.gathered;
        let transmittance = before.transmittance + taken * (one - before.transmittance);
        self.largest = unit.max(self.largest);
        self.maximum = Some(self.maximum.map_or(value, |m| value.max(m)));
        before.color = add(
            scale(before.color, one - taken),
            scale([r, g, b], transmittance * opacity),
        );
        before.transmittance = transmittance * (one - opacity);
        if before.transmittance > half {
            before.depth = None;
        } else if transmittance > half {
            before.depth = Some(t);
        }
    }

    /// True where the ray may end: no larger value can come, or would take nothing, and no light comes through.
    pub fn is_finished(&self, frame: &Frame) -> bool {
        let is_settled = self.largest >= R::from_f64(1.0) || frame.mida_fade == 0.0;
        let is_behind = self.gathered.transmittance < R::from_f32(frame.termination);
        is_settled && frame.mida_mip == 0.0 && is_behind
    }

    /// What the picture gets, with depth: for gamma over 0 mixed with the maximum, whose material `classify` gives.
    pub fn picture(&self, frame: &Frame, classify: impl Fn(R) -> [R; 4]) -> Composite<R> {
        let (one, share) = (R::from_f64(1.0), R::from_f32(frame.mida_mip));
        let Some(maximum) = self.maximum.filter(|_| frame.mida_mip != 0.0) else {
            return self.gathered;
        };
        let [r, g, b, extinction] = classify(maximum);
        let opacity = opacity_over(extinction, R::from_f32(frame.reference_length));
        // The largest extinction stands for opacity 1.
        let shown = if opacity > R::from_f32(0.999_755) {
            one
        } else {
            opacity
        };
        let Composite {
            color,
            transmittance,
            depth,
        } = self.gathered;
        let mixed = |found: R, wanted: R| found + share * (wanted - found);
        let of_maximum = scale([r, g, b], shown);
        Composite {
            color: std::array::from_fn(|c| mixed(color[c], of_maximum[c])),
            transmittance: one - mixed(one - transmittance, shown),
            depth,
        }
    }
}
