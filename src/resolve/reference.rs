//! Accumulation to colour on the CPU: CPU reference of `shaders/resolve.wgsl`.
//!
//! ```text
//! composite           the picture itself
//! projecting modes    (alpha0 c(v), alpha0(v)) of one value v, classified once
//! ```

use crate::real::Real;
use crate::shaders::Frame;
use crate::technique::Mode;

/// The value that a projecting mode shows, from (value, weight, .., ..); `None` without a valid sample.
pub fn projected_value<R: Real>(mode: Mode, [value, weight, ..]: [R; 4]) -> Option<R> {
    if weight == R::from_f64(0.0) {
        return None;
    }
    Some(if mode == Mode::Average {
        value / weight
    } else {
        value
    })
}

/// Premultiplied colour of what a technique left. `classify_once` gives (red, green, blue, opacity).
pub fn premultiplied<R: Real>(
    mode: Mode,
    accumulation: [R; 4],
    classify_once: impl Fn(R) -> [R; 4],
) -> [R; 4] {
    if !mode.is_projection() {
        return accumulation;
    }
    let Some(value) = projected_value(mode, accumulation) else {
        return [R::from_f64(0.0); 4];
    };
    let [r, g, b, opacity] = classify_once(value);
    [opacity * r, opacity * g, opacity * b, opacity]
}

/// How much light is left at a depth: CPU reference of `shaders/lib/resolve_cued.wgsl`.
pub fn light_at<R: Real>(frame: &Frame, depth: R) -> R {
    let (zero, one) = (R::from_f64(0.0), R::from_f64(1.0));
    let far = (depth - R::from_f32(frame.depth_near)) * R::from_f32(frame.depth_scale);
    one - R::from_f32(frame.depth_cue) * far.max(zero).min(one)
}
