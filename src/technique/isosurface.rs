//! Surfaces of one value or of several along a ray: CPU reference of `shaders/isosurface.wgsl`.
//!
//! A crossing lies wherever one end of a segment is under a level and the other is not (at the level is over it). It
//! is found by halving the segment ten times, which leaves 2^-10 of a step, and by a straight line between the ends
//! of that (Hadwiger, Sigg, Scharsach, Buehler and Gross, Computer Graphics Forum 24(3), 2005, refine so). The ends
//! are those of the segments of the lattice `ray`, where the ray enters and leaves the domain among them.
//!
//! ```text
//! C += T a c        T *= 1 - a        c, a of the level, c lit by the gradient at the crossing
//! ```

use crate::ray::{domain_interval, pixel_ray, visible_interval, voxel_ray};
use crate::real::{Real, add, scale};
use crate::shaders::Frame;

/// Halvings of a segment.
const HALVINGS: u32 = 10;

/// What one ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surfaces<R> {
    /// Premultiplied colour.
    pub color: [R; 3],
    /// Light that still comes through.
    pub transmittance: R,
    /// Level and depth of the first crossing.
    pub first: Option<(R, R)>,
    /// Ends of segments that were looked at.
    pub samples: u32,
}

/// One end of a segment; no value is no data.
#[derive(Clone, Copy)]
struct End<R> {
    t: R,
    value: R,
}

/// What a pixel's ray meets. `value_at` filters the volume at a position in voxel space; `lit` gives the colour of a
/// level's own colour there, seen along the ray's direction in the world.
pub fn surfaces<R: Real>(
    frame: &Frame,
    pixel: [R; 2],
    value_at: impl Fn([R; 3]) -> Option<R>,
    lit: impl Fn([R; 3], [R; 3], [R; 3]) -> [R; 3],
) -> Surfaces<R> {
    let (zero, one) = (R::from_f64(0.0), R::from_f64(1.0));
    let mut so_far = Surfaces {
        color: [zero; 3],
        transmittance: one,
        first: None,
        samples: 0,
    };
    let world = pixel_ray(frame, pixel);
    let voxel = voxel_ray(frame, &world);
    let [t0, t1] = visible_interval(frame, domain_interval(frame, &world, &voxel), &world);
    if t0 >= t1 {
        return so_far;
    }
    let step = R::from_f32(frame.step_world);
    let full = ((t1 - t0) / step).floor().to_i32();
    let end_at = |t: R| value_at(voxel.at(t)).map(|value| End { t, value });
    let mut near = end_at(t0);
    so_far.samples = 1;
    for k in 1..=full.saturating_add(1) {
        let far = end_at((t0 + R::from_f64(f64::from(k)) * step).min(t1));
        so_far.samples += 1;
        // Between a value and no data there is no surface.
        if let (Some(near), Some(far)) = (near, far) {
            for (index, t) in crossings(frame, near, far, end_at) {
                so_far.pass(frame, index, t, |color| {
                    lit(color, voxel.at(t), world.direction)
                });
            }
            let left = so_far.transmittance;
            // Nothing is seen behind what is opaque.
            if left < R::from_f32(frame.termination) || left == zero {
                break;
            }
        }
        near = far;
    }
    so_far
}

/// The levels between two ends, in the order in which the ray meets them, and where it does.
fn crossings<R: Real>(
    frame: &Frame,
    near: End<R>,
    far: End<R>,
    end_at: impl Fn(R) -> Option<End<R>>,
) -> Vec<(usize, R)> {
    let count = frame.level_count as usize;
    let mut found = Vec::new();
    let mut start = near;
    for i in 0..count {
        let index = if far.value > near.value {
            i
        } else {
            count - 1 - i
        };
        let level = R::from_f32(frame.level_values[index][0]);
        let is_transparent = frame.level_colors[index][3] == 0.0;
        if (start.value < level) == (far.value < level) || is_transparent {
            continue;
        }
        let Some([a, b]) = narrowed(level, start, far, &end_at) else {
            continue;
        };
        let part = (level - a.value) / (b.value - a.value);
        let part = part.max(R::from_f64(0.0)).min(R::from_f64(1.0));
        found.push((index, a.t + part * (b.t - a.t)));
        // The next level lies behind.
        start = a;
    }
    found
}

/// The 2^-10 of the segment that a crossing lies in; none where a half has no data.
fn narrowed<R: Real>(
    level: R,
    mut near: End<R>,
    mut far: End<R>,
    end_at: impl Fn(R) -> Option<End<R>>,
) -> Option<[End<R>; 2]> {
    for _ in 0..HALVINGS {
        let middle = end_at(R::from_f64(0.5) * (near.t + far.t))?;
        if (middle.value < level) == (near.value < level) {
            near = middle;
        } else {
            far = middle;
        }
    }
    Some([near, far])
}

impl<R: Real> Surfaces<R> {
    fn pass(&mut self, frame: &Frame, index: usize, t: R, lit: impl Fn([R; 3]) -> [R; 3]) {
        let [r, g, b, opacity] = frame.level_colors[index].map(R::from_f32);
        let color = lit([r, g, b]);
        self.color = add(self.color, scale(color, self.transmittance * opacity));
        self.transmittance = self.transmittance * (R::from_f64(1.0) - opacity);
        if self.first.is_none() {
            let level = R::from_f32(frame.level_values[index][0]);
            self.first = Some((level, t));
        }
    }
}
