//! Emission and absorption, front to back: CPU reference of `shaders/lib/mode_composite.wgsl`.
//!
//! ```text
//! C += T alpha c        T *= 1 - alpha
//! ```
//!
//! Max, "Optical Models for Direct Volume Rendering", IEEE TVCG 1(2), 1995; `sampling.md` 5.

use crate::real::{Real, add, scale};
use crate::transfer::opacity_over;

/// What a ray has gathered so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Composite<R> {
    /// Premultiplied colour.
    pub color: [R; 3],
    /// Light that still comes through.
    pub transmittance: R,
    /// Where opacity reached one half.
    pub depth: Option<R>,
}

impl<R: Real> Default for Composite<R> {
    fn default() -> Self {
        Self {
            color: [R::from_f64(0.0); 3],
            transmittance: R::from_f64(1.0),
            depth: None,
        }
    }
}

impl<R: Real> Composite<R> {
    /// Adds a segment of `length` world length at `t`, of a material (red, green, blue, extinction).
    pub fn add(&mut self, [r, g, b, extinction]: [R; 4], length: R, t: R) {
        let opacity = opacity_over(extinction, length);
        self.color = add(self.color, scale([r, g, b], self.transmittance * opacity));
        self.transmittance = self.transmittance * (R::from_f64(1.0) - opacity);
        if self.depth.is_none() && self.transmittance <= R::from_f64(0.5) {
            self.depth = Some(t);
        }
    }
}
