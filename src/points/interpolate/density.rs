//! How much weight there is in a volume, as smoothed particle hydrodynamics has it; in a plane, on an area.
//!
//! ```text
//! f(x) = sum of m_s W(|x - x_s| / R) / N,   W(r) = (1 - r)^4 (4 r + 1) for r < 1
//! N    = 2 pi R^3 / 21, the integral of W over a ball; in a plane pi R^2 / 7
//! ```
//!
//! with m_s the weight of a point, 1 where none is given: the integral is the sum of weights. Wendland, "Piecewise polynomial,
//! positive definite and compactly supported radial functions of minimal degree", Advances in Computational Mathematics 4,
//! 1995 (C2); Dehnen and Aly, "Improving convergence in smoothed particle hydrodynamics", MNRAS 425, 2012.

use std::f64::consts::PI;

/// Wendland's function of a distance in radii, 1 at 0.
pub(super) fn wendland(r: f64) -> f64 {
    let rest = (1.0 - r).max(0.0);
    let squared = rest * rest;
    squared * squared * (4.0 * r + 1.0)
}

/// The integral of the function with this radius.
pub(super) fn integral(radius: f64, is_in_plane: bool) -> f64 {
    match is_in_plane {
        false => 2.0 * PI / 21.0 * radius.powi(3),
        true => PI / 7.0 * radius.powi(2),
    }
}

/// Per unit of the space that distances are of.
pub(super) fn value(near: &[(u32, f64)], radius: f64, weights: &[f64], integral: f64) -> f64 {
    let weight =
        |&(index, distance): &(u32, f64)| weights[index as usize] * wendland(distance / radius);
    near.iter().map(weight).sum::<f64>() / integral
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_integral_of_the_kernel_is_what_is_written() {
        let steps = 20_000;
        let radii = (0..steps).map(|i| (f64::from(i) + 0.5) / f64::from(steps));
        let (mut ball, mut disc) = (0.0, 0.0);
        for r in radii {
            ball += 4.0 * PI * r * r * wendland(r) / f64::from(steps);
            disc += 2.0 * PI * r * wendland(r) / f64::from(steps);
        }
        assert!((ball / integral(1.0, false) - 1.0).abs() < 1e-7, "{ball}");
        assert!((disc / integral(1.0, true) - 1.0).abs() < 1e-7, "{disc}");
        assert_eq!(integral(2.0, false), 8.0 * integral(1.0, false));
    }
}
