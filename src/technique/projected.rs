//! What a ray keeps that projects samples, of its own or of sheets of splats, on the CPU.
//!
//! ```text
//! mip, minip   value = extreme of v, of equal ones the first
//! average      value = sum of v d / sum of d
//! xray         value = sum of v d
//! lmip         value = the extreme up to where v first falls from over the threshold
//! attenuated   value = extreme of u exp(-attenuation sum of u d of those before), u the value from 0 to 1
//! ```

use super::Mode;
use super::per_mode::{unit_from_value, value_from_unit};
use crate::lattice::Segment;
use crate::real::Real;
use crate::shaders::Frame;
use std::ops::ControlFlow;

/// What one ray projects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projected<R> {
    /// The extreme, or the sum of v d.
    pub value: R,
    /// 0 without a valid sample; the sum of d where the mode adds up, 1 and the sum of u d where it attenuates, 2
    /// past a local maximum.
    pub weight: R,
    /// Where the extreme lies.
    pub depth: Option<R>,
}

impl<R: Real> Default for Projected<R> {
    fn default() -> Self {
        Self {
            value: R::from_f64(0.0),
            weight: R::from_f64(0.0),
            depth: None,
        }
    }
}

impl<R: Real> Projected<R> {
    /// Takes one more sample in; breaks where no further one counts.
    pub fn add(
        &mut self,
        frame: &Frame,
        mode: Mode,
        value: R,
        segment: Segment<R>,
    ) -> ControlFlow<()> {
        let is_first = self.weight == R::from_f64(0.0);
        match mode {
            Mode::Mip | Mode::Lmip if is_first || value > self.value => self.win(value, segment.t),
            Mode::Minip if is_first || value < self.value => self.win(value, segment.t),
            Mode::Lmip => {
                let is_over = self.value > R::from_f32(frame.lmip_threshold);
                if value < self.value && is_over {
                    self.weight = R::from_f64(2.0);
                    return ControlFlow::Break(());
                }
            }
            Mode::Mip | Mode::Minip => {}
            Mode::AttenuatedMip => self.attenuate(frame, value, segment),
            Mode::Average | Mode::Xray | Mode::Composite | Mode::Mida | Mode::Iso => {
                self.value = self.value + value * segment.length;
                self.weight = self.weight + segment.length;
            }
        }
        ControlFlow::Continue(())
    }

    fn win(&mut self, value: R, t: R) {
        *self = Self {
            value,
            weight: R::from_f64(1.0),
            depth: Some(t),
        };
    }

    fn attenuate(&mut self, frame: &Frame, value: R, segment: Segment<R>) {
        let (zero, one) = (R::from_f64(0.0), R::from_f64(1.0));
        let unit = unit_from_value(frame, value);
        let before = (self.weight - one).max(zero);
        let share = (-R::from_f32(frame.attenuation) * before).exp();
        let faded = value_from_unit(frame, unit * share);
        if self.weight == zero || faded > self.value {
            self.win(faded, segment.t);
        }
        self.weight = one + (before + unit * segment.length);
    }
}
