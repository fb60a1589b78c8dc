//! MIP and its relatives on the CPU: twin of `shaders/projection.wgsl` and of its modes.
//!
//! ```text
//! mip, minip   value = extreme of v, of equal ones the first
//! average      value = sum of v d / sum of d
//! xray         value = sum of v d
//! ```

use crate::lattice::Segment;
use crate::real::Real;
use crate::shaders::Frame;
use crate::technique::march::march;
use crate::technique::{Lattice, Mode};
use std::ops::ControlFlow;

/// What one ray projects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projected<R> {
    /// The extreme, or the sum of v d.
    pub value: R,
    /// 0 without a valid sample; the sum of d where the mode adds up.
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
    /// Takes one more sample in.
    pub fn add(&mut self, mode: Mode, value: R, segment: Segment<R>) {
        let is_first = self.weight == R::from_f64(0.0);
        let wins = match mode {
            Mode::Mip => value > self.value,
            Mode::Minip => value < self.value,
            Mode::Composite | Mode::Average | Mode::Xray => {
                self.value = self.value + value * segment.length;
                self.weight = self.weight + segment.length;
                return;
            }
        };
        if is_first || wins {
            *self = Self {
                value,
                weight: R::from_f64(1.0),
                depth: Some(segment.t),
            };
        }
    }
}

/// What one ray projects, and how many samples it took.
pub fn project<R: Real>(
    frame: &Frame,
    lattice: Lattice,
    mode: Mode,
    pixel: [R; 2],
    value_at: impl Fn([R; 3]) -> Option<R>,
) -> (Projected<R>, u32) {
    let mut so_far = Projected::default();
    let samples = march(frame, lattice, pixel, value_at, |value, segment| {
        so_far.add(mode, value, segment);
        ControlFlow::Continue(())
    });
    (so_far, samples)
}
