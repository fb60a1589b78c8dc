//! Inverse distances with a radius.
//!
//! ```text
//! f(x) = sum of w_s f_s / sum of w_s,   w_s = ((R - d_s) / (R d_s))^2,   d_s = |x - x_s|
//! ```
//!
//! over the 16 nearest points; R is the distance of the next one, where its weight would be 0. Shepard, "A two-dimensional
//! interpolation function for irregularly-spaced data", ACM 1968; this weight is Franke's and Little's ("Scattered data
//! interpolation: tests of some methods", Mathematics of Computation 38, 1982).
//!
//! Values at points and constants are reproduced; points are flat spots.

use super::Found;

/// Points that have weight.
pub(super) const NEAREST: usize = 16;
/// Where there is no next point, R is so many times the distance of the farthest.
const BEYOND: f64 = 1.1;

pub(super) fn value(found: &[Found], values: &[f64]) -> f64 {
    mean(found, |index| values[index])
}

/// The mean by these weights of what the nearest points say.
pub(super) fn mean(found: &[Found], says: impl Fn(usize) -> f64) -> f64 {
    let nearest = found[0].0.sqrt();
    if nearest == 0.0 {
        return says(found[0].1 as usize);
    }
    let (with_weight, radius) = match found {
        [all @ .., next] if all.len() == NEAREST => (all, next.0.sqrt()),
        all => (all, BEYOND * all.last().map_or(0.0, |far| far.0.sqrt())),
    };
    let (mut sum, mut weights) = (0.0, 0.0);
    for &(squared, index) in with_weight {
        let distance = squared.sqrt();
        // Times (R d_0)^2 for all: of the nearest none is too large for a number.
        let root = (radius - distance) * nearest / (radius * distance);
        let weight = root * root;
        sum += weight * says(index as usize);
        weights += weight;
    }
    // All are as far away as the next one.
    if weights == 0.0 {
        let all = with_weight.iter().map(|&(_, index)| says(index as usize));
        return all.sum::<f64>() / with_weight.len() as f64;
    }
    sum / weights
}
