//! Emission and absorption in which a new maximum takes from what lies before it: twin of
//! `shaders/lib/mode_mida.wgsl`.
//!
//! ```text
//! beta = 1 - max(u - m, 0) (1 + gamma)        u the value from 0 to 1, m the largest of those before
//! C = beta C + (1 - beta A) alpha c           A = beta A + (1 - beta A) alpha
//! ```
//!
//! Bruckner and Groeller, "Instant Volume Visualization using Maximum Intensity Difference Accumulation", Computer
//! Graphics Forum 28(3), 2009; for gamma from -1, where this is compositing, to 0.

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
}

impl<R: Real> Default for Mida<R> {
    fn default() -> Self {
        Self {
            gathered: Composite::default(),
            largest: R::from_f64(0.0),
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
        is_settled && self.gathered.transmittance < R::from_f32(frame.termination)
    }
}
