//! Where the samples of a ray lie and the length that each stands for (`sampling.md` 3), in f64 and of nothing but
//! numbers.

use glam::DVec3;

/// Equal steps, and a shorter one at the end.
pub fn segments(enter: f64, leave: f64, h: f64) -> Vec<(f64, f64)> {
    let full = ((leave - enter) / h).floor() as usize;
    let start = |i: usize| enter + i as f64 * h;
    let mut samples: Vec<_> = (0..full).map(|i| (start(i) + 0.5 * h, h)).collect();
    let rest = leave - start(full);
    if rest > 0.0 {
        samples.push((start(full) + 0.5 * rest, rest));
    }
    samples
}

/// The axis that a ray of this direction runs along most, the lowest of those that are within 2^-16, and whether that depends
/// on rounding.
pub fn main_axis(direction: DVec3) -> (usize, bool) {
    let sizes = direction.abs();
    let shares = (sizes / sizes.max_element()).to_array();
    let least = 1.0 - 2f64.powi(-16);
    let axis = shares.iter().position(|&share| share >= least);
    let hangs = shares
        .iter()
        .any(|share| (share - least).abs() < 2f64.powi(-17));
    (axis.unwrap_or(2), hangs)
}

/// Where `height + t slope` is a whole number and a half times `spacing`, and whether their number depends on rounding: a
/// plane's own t may be off by `blur`, as the ends may.
pub fn planes(
    ends: [f64; 2],
    blur: f64,
    height: f64,
    slope: f64,
    spacing: f64,
) -> (Vec<(f64, f64)>, bool) {
    if slope == 0.0 {
        return (Vec::new(), true);
    }
    let at = |t: f64| (height + t * slope) / spacing - 0.5;
    let ends = ends.map(at);
    let near = 2.0 * blur * slope.abs() / spacing;
    let hangs = ends.iter().any(|end| (end - end.round()).abs() <= near);
    let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    let length = spacing / slope.abs();
    let t_of = |k: i64| ((k as f64 + 0.5) * spacing - height) / slope;
    let mut samples: Vec<_> = (low.ceil() as i64..=high.floor() as i64)
        .map(|k| (t_of(k), length))
        .collect();
    if slope < 0.0 {
        samples.reverse();
    }
    (samples, hangs)
}
