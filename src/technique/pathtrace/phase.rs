//! Where a medium scatters light to: the words, and the CPU reference of `shaders/lib/phase.wgsl`.
//!
//! ```text
//! isotropic             1 / 4 pi
//! Henyey & Greenstein   (1 - g^2) / (4 pi d^(3/2))      d = (1 - g)^2 + 2 g (1 - c)
//! two lobes             f p(g1) + (1 - f) p(g2)
//! Rayleigh              3 (1 + c^2) / 16 pi
//! ```
//!
//! per steradian, of the cosine c between the directions of travel before and behind: a light behind the eye is scattered
//! back, c = -1. Henyey & Greenstein, Astrophysical Journal 93, 1941.

use crate::real::Real;
use crate::shaders::Frame;
use crate::transfer::Phase;
use std::f64::consts::PI;

impl Phase {
    /// What the shader is told: f, g1, g2, and 1 for Rayleigh.
    pub(super) fn numbers(self) -> [f32; 4] {
        let [f, g1, g2, is_rayleigh] = match self {
            Self::Isotropic => [1.0, 0.0, 0.0, 0.0],
            Self::Rayleigh => [1.0, 0.0, 0.0, 1.0],
            Self::HenyeyGreenstein(g) => [1.0, g, g, 0.0],
            Self::TwoLobes { part, g: [g1, g2] } => [part, g1, g2, 0.0],
        };
        [f, g1, g2, is_rayleigh].map(|n| n as f32)
    }

    /// Whether it sends light to all sides alike.
    pub(in crate::technique) fn is_even(self) -> bool {
        self != Self::Rayleigh && self.parts().1 == [0.0; 2]
    }

    /// The cosines and the part, which have ranges.
    pub(super) fn parts(self) -> (f64, [f64; 2]) {
        match self {
            Self::Isotropic | Self::Rayleigh => (1.0, [0.0; 2]),
            Self::HenyeyGreenstein(g) => (1.0, [g; 2]),
            Self::TwoLobes { part, g } => (part, g),
        }
    }
}

/// Density at a cosine, per steradian.
pub fn phase_value<R: Real>(frame: &Frame, c: R) -> R {
    let n = |x: f64| R::from_f64(x);
    let [f, g1, g2, is_rayleigh] = frame.path_phase;
    if is_rayleigh != 0.0 {
        return n(3.0) * (n(1.0) + c * c) / n(16.0 * PI);
    }
    let f = R::from_f32(f);
    f * lobe(R::from_f32(g1), c) + (n(1.0) - f) * lobe(R::from_f32(g2), c)
}

fn lobe<R: Real>(g: R, c: R) -> R {
    let (one, two) = (R::from_f64(1.0), R::from_f64(2.0));
    let d = (one - g) * (one - g) + two * g * (one - c);
    (one - g * g) / (R::from_f64(4.0 * PI) * d * d.sqrt())
}

/// A cosine with this density, by two numbers from 0 to 1.
pub fn phase_cosine<R: Real>(frame: &Frame, lobe_by: R, u: R) -> R {
    let n = |x: f64| R::from_f64(x);
    let one = n(1.0);
    let [f, g1, g2, is_rayleigh] = frame.path_phase;
    if is_rayleigh != 0.0 {
        let z = n(4.0) * u - n(2.0);
        let a = cube_root(z.abs() + (z * z + one).sqrt());
        let c = a - one / a;
        return if z < n(0.0) { -c } else { c };
    }
    let g = R::from_f32(if lobe_by < R::from_f32(f) { g1 } else { g2 });
    let c = if g.abs() < n(0.5) {
        let v = n(2.0) * u - one;
        let q = one + g * v;
        let sum =
            v + n(0.5) * g * (v * v + n(3.0)) + g * g * v + n(0.5) * g * g * g * (v * v - one);
        sum / (q * q)
    } else {
        let s = (one - g * g) / (one - g + n(2.0) * g * u);
        (one + g * g - s * s) / (n(2.0) * g)
    };
    c.max(-one).min(one)
}

/// Of numbers from 1 to 5.
fn cube_root<R: Real>(x: R) -> R {
    let n = |x: f64| R::from_f64(x);
    let start = n(0.6) + n(0.4) * x - n(0.035) * x * x;
    (0..4).fold(start, |root, _| {
        (n(2.0) * root + x / (root * root)) / n(3.0)
    })
}

#[cfg(test)]
mod tests {
    use super::super::random::random_numbers;
    use super::*;

    fn frame(phase: Phase) -> Frame {
        let mut frame: Frame = bytemuck::Zeroable::zeroed();
        frame.path_phase = phase.numbers();
        frame
    }

    const PHASES: [Phase; 7] = [
        Phase::Isotropic,
        Phase::Rayleigh,
        Phase::HenyeyGreenstein(0.3),
        Phase::HenyeyGreenstein(-0.6),
        Phase::HenyeyGreenstein(0.85),
        Phase::HenyeyGreenstein(1e-4),
        Phase::TwoLobes {
            part: 0.7,
            g: [0.8, -0.4],
        },
    ];

    /// Cosines of that many directions.
    const COUNT: u32 = 1 << 18;

    fn cosines(phase: Phase) -> impl Iterator<Item = f64> {
        let frame = frame(phase);
        (0..COUNT).map(move |i| {
            let [u, v, ..] = random_numbers::<f64>([i, 0, 8, 3]);
            phase_cosine(&frame, u, v)
        })
    }

    /// Legendre moments of Henyey and Greenstein's function are g^l, l up to 5; Rayleigh's mean square is 2/5. Within four standard
    /// errors.
    #[test]
    fn moments_of_cosines_are_those_of_the_density() {
        for phase in PHASES {
            let mut sums = [[0.0; 2]; 6];
            for c in cosines(phase) {
                let mut legendre = [1.0, c, 0.0, 0.0, 0.0, 0.0];
                for l in 2..6 {
                    let n = l as f64;
                    let next = (2.0 * n - 1.0) * c * legendre[l - 1] - (n - 1.0) * legendre[l - 2];
                    legendre[l] = next / n;
                }
                for (sum, p) in sums.iter_mut().zip(legendre) {
                    *sum = [sum[0] + p, sum[1] + p * p];
                }
            }
            let (f, [g1, g2]) = phase.parts();
            let moment = |l: i32| match phase {
                Phase::Rayleigh => [1.0, 0.0, 0.1, 0.0, 0.0, 0.0][l as usize],
                _ => f * g1.powi(l) + (1.0 - f) * g2.powi(l),
            };
            for (l, [sum, squares]) in (0..).zip(sums) {
                let n = f64::from(COUNT);
                let found: f64 = sum / n;
                let error = ((squares / n - found * found).max(0.0) / n).sqrt();
                let off = found - moment(l);
                assert!(
                    off.abs() <= 4.0 * error,
                    "{phase:?} {l}: {found} +- {error}"
                );
            }
        }
    }

    /// chi^2 of 100 bins of cosines lies within four standard deviations of 99; bins of less than five directions are none.
    #[test]
    fn cosines_are_drawn_by_the_density() {
        for phase in PHASES {
            let frame = frame(phase);
            let mut bins = [0.0; 100];
            for c in cosines(phase) {
                bins[((50.0 * (c + 1.0)) as usize).min(99)] += 1.0;
            }
            let [mut chi, mut count] = [0.0, -1.0];
            for (bin, &found) in bins.iter().enumerate() {
                let steps = 200;
                let c =
                    |i: i32| -1.0 + 0.02 * (bin as f64 + (f64::from(i) + 0.5) / f64::from(steps));
                let sum: f64 = (0..steps).map(|i| phase_value(&frame, c(i))).sum();
                let wanted = f64::from(COUNT) * 2.0 * PI * sum * 0.02 / f64::from(steps);
                if wanted >= 5.0 {
                    chi += (found - wanted) * (found - wanted) / wanted;
                    count += 1.0;
                }
            }
            let off: f64 = (chi - count) / (2.0_f64 * count).sqrt();
            assert!(off.abs() <= 4.0, "{phase:?}: chi^2 {chi} of {count}");
        }
    }

    #[test]
    fn densities_integrate_to_one_over_the_sphere() {
        for phase in PHASES {
            let frame = frame(phase);
            let count = 200_000;
            let c = |i: i32| -1.0 + 2.0 * (f64::from(i) + 0.5) / f64::from(count);
            let sum: f64 = (0..count).map(|i| phase_value(&frame, c(i))).sum();
            let integral = 2.0 * PI * sum * 2.0 / f64::from(count);
            assert!((integral - 1.0).abs() < 1e-6, "{phase:?}: {integral}");
        }
    }
}
