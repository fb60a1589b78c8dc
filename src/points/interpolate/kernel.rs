//! The mean of the values around, weighted by a kernel: smooth, and never out of their range.
//!
//! ```text
//! f(x) = sum of m_s f_s W(|x - x_s| / R) / sum of m_s W(|x - x_s| / R)
//! ```
//!
//! with m_s the weight of a point and W as in the density. Nadaraya, "On estimating regression", Theory of Probability
//! 9(1), 1964; in smoothed particle hydrodynamics Shepard's correction.

use super::density::wendland;

/// `None` where no weight reaches.
pub(super) fn value(
    near: &[(u32, f64)],
    radius: f64,
    values: &[f64],
    weights: &[f64],
) -> Option<f64> {
    let (mut sum, mut of_weights) = (0.0, 0.0);
    for &(index, distance) in near {
        let weight = weights[index as usize] * wendland(distance / radius);
        sum += weight * values[index as usize];
        of_weights += weight;
    }
    (of_weights > 0.0).then(|| sum / of_weights)
}
