//! Functions that drivers compute each in their own way, by sums and products alone: CPU reference of
//! `shaders/lib/elementary.wgsl`.

use crate::real::{Real, add, scale};

/// -ln(x) of 2^-24 <= x <= 1, a number of 24 bits.
pub fn minus_ln<R: Real>(x: R) -> R {
    let bits = (x.to_f64() as f32).to_bits();
    let mut exponent = (bits >> 23) as f64 - 127.0;
    let mut m = f32::from_bits(bits & 0x7f_ffff | 0x3f80_0000);
    if m >= std::f32::consts::SQRT_2 {
        m *= 0.5;
        exponent += 1.0;
    }
    let n = |x: f64| R::from_f64(x);
    let m = R::from_f32(m);
    let s = (m - n(1.0)) / (m + n(1.0));
    let q = s * s;
    let series = [1.0 / 9.0, 1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0];
    let series = series.into_iter().fold(n(0.0), |sum, c| q * (n(c) + sum));
    -(n(exponent) * n(std::f64::consts::LN_2) + n(2.0) * s * (n(1.0) + series))
}

/// Cosine and sine of a part of a turn, 0 to 1.
pub fn turned<R: Real>(part: R) -> [R; 2] {
    let n = |x: f64| R::from_f64(x);
    let quarter = (n(4.0) * part + n(0.5)).floor();
    let x = n(std::f64::consts::TAU) * (part - n(0.25) * quarter);
    let q = x * x;
    let series = |terms: [f64; 4]| {
        let terms = terms.into_iter().rev();
        n(1.0) + terms.fold(n(0.0), |sum, c| q * (n(c) + sum))
    };
    let c = series([-1.0 / 2.0, 1.0 / 24.0, -1.0 / 720.0, 1.0 / 40320.0]);
    let s = x * series([-1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362_880.0]);
    match quarter.to_i32() & 3 {
        0 => [c, s],
        1 => [-s, c],
        2 => [-c, -s],
        _ => [s, -c],
    }
}

/// Which part of a turn a vector points to from x on, -1/2 to 1/2.
pub fn turn_of<R: Real>([x, y]: [R; 2]) -> R {
    let n = |x: f64| R::from_f64(x);
    let half = [x.abs() + (x * x + y * y).sqrt(), y.abs()];
    let norm = (half[0] * half[0] + half[1] * half[1]).sqrt();
    let t = half[1] / (half[0] + norm).max(n(1e-30));
    let q = t * t;
    let terms = [-1.0 / 11.0, 1.0 / 9.0, -1.0 / 7.0, 1.0 / 5.0, -1.0 / 3.0];
    let series = terms.into_iter().fold(n(0.0), |sum, c| q * (n(c) + sum));
    let quarter = n(std::f64::consts::FRAC_2_PI) * t * (n(1.0) + series);
    let turn = match x >= n(0.0) {
        true => quarter,
        false => n(0.5) - quarter,
    };
    match y >= n(0.0) {
        true => turn,
        false => -turn,
    }
}

/// The direction at this cosine and part of a turn around a unit vector (Duff et al. 2017).
pub fn around<R: Real>(axis: [R; 3], cosine: R, part: R) -> [R; 3] {
    let (zero, one) = (R::from_f64(0.0), R::from_f64(1.0));
    let [x, y, z] = axis;
    let side = if z >= zero { one } else { -one };
    let a = -one / (side + z);
    let b = x * y * a;
    let first = [one + side * x * x * a, side * b, -side * x];
    let second = [b, side + y * y * a, -y];
    let sine = (one - cosine * cosine).max(zero).sqrt();
    let [c, s] = turned(part).map(|t| sine * t);
    add(add(scale(first, c), scale(second, s)), scale(axis, cosine))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_comes_back_from_its_vector() {
        for i in 0..1000 {
            let part = (f64::from(i) + 0.5) / 1000.0 - 0.5;
            let (sine, cosine) = (std::f64::consts::TAU * part).sin_cos();
            let found = turn_of([3.0 * cosine, 3.0 * sine]);
            assert!((found - part).abs() < 1e-6, "{part} {found}");
        }
        assert_eq!(turn_of([0.0, 0.0]), 0.0);
        assert_eq!(turn_of([1.0, 0.0]), 0.0);
    }
    use crate::real::dot;

    #[test]
    fn logarithm_and_circle_are_as_near_as_f32_can_tell() {
        for i in 1..=4096_u32 {
            let x = f64::from(i) / 4096.0;
            let wanted = -x.ln();
            let found = [minus_ln(x), minus_ln(x as f32).into()];
            for (found, slack) in found.into_iter().zip([2e-8, 3e-7]) {
                assert!((found - wanted).abs() <= slack * (1.0 + wanted), "{x}");
            }
            let angle = std::f64::consts::TAU * x;
            let [c, s] = turned(x as f32).map(f64::from);
            assert!((c - angle.cos()).hypot(s - angle.sin()) < 3e-7, "{x}");
        }
        assert_eq!(minus_ln(1.0_f32), 0.0);
        assert!(minus_ln(2.0_f32.powi(-24)) > 16.0);
    }

    #[test]
    fn a_direction_around_an_axis_has_its_cosine() {
        for axis in [
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -1.0],
            [0.48, -0.6, 0.64],
            [0.6, 0.64, -0.48],
        ] {
            for (cosine, part) in [(1.0, 0.3), (-1.0, 0.9), (0.25, 0.6), (-0.7, 0.1)] {
                let found: [f64; 3] = around(axis, cosine, part);
                assert!((dot(found, axis) - cosine).abs() < 1e-7);
                assert!((dot(found, found) - 1.0).abs() < 1e-6);
            }
        }
    }
}
