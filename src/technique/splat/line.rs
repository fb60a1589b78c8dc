//! What a ray makes of splats: CPU reference of `shaders/lib/splat_line.wgsl`.
//!
//! A ray v(t) = o + t d of voxel space meets slice m of axis k at t_m. With w = (w_i, w_j) from there to the centre c
//! of a voxel of the slice and M the precision,
//!
//! ```text
//! t* = t_m + g.w         g = (Md)_ij / (d.Md)                          where the splat is densest along the ray
//! b^2 = w.Qw             Q = M_ij - (Md)_i (Md)_j / (d.Md)             how far from it the ray passes, in deviations
//! F = peak e^(-b^2 / 2) / kappa        kappa = sqrt(d.Md)              its integral along the ray, 0 beyond R
//! F (Phi(kappa (t_b - t*)) - Phi(kappa (t_a - t*)))                    the same between t_a and t_b
//! |w_i| <= R sqrt(Q^-1_ii)        |t* - t_m| <= R sqrt(g.Q^-1 g)
//! ```
//!
//! From the crossing of the slice, b^2 keeps its digits; from an eye far away it has none left.

use super::kernel::Kernel;
use crate::ray::Ray;
use crate::real::Real;
use crate::shaders::Frame;
use crate::technique::stack_axis::axes_across;

/// A ray among splats. Vectors have the two axes across its slices first, the lower one before the other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<R> {
    /// Across its slices, and along them.
    pub axes: [usize; 3],
    pub origin: [R; 3],
    pub direction: [R; 3],
    /// Q_ii, Q_ij, Q_jj.
    pub form: [R; 3],
    /// g.
    pub drift: [R; 2],
    pub kappa: R,
    /// F of a splat that the ray goes through the middle of.
    pub peak: R,
    /// How far from the crossing splats lie, in voxels.
    pub half_widths: [R; 2],
    /// How far before and behind the crossing, in world length, they have any part.
    pub reach: R,
    /// R.
    pub cut: R,
}

impl<R: Real> Line<R> {
    /// Among the slices of axis `k`, with the kernel of the parameters.
    pub fn new(frame: &Frame, k: usize, voxel: &Ray<R>) -> Self {
        let [diagonal, mixed] =
            [frame.splat_diagonal, frame.splat_mixed].map(|v| v.map(R::from_f32));
        let (cut, peak) = (
            R::from_f32(frame.splat_reach),
            R::from_f32(frame.splat_peak),
        );
        Self::of(diagonal, mixed, cut, peak, k, voxel.origin, voxel.direction)
    }

    fn of(
        diagonal: [R; 3],
        mixed: [R; 3],
        cut: R,
        peak: R,
        k: usize,
        origin: [R; 3],
        direction: [R; 3],
    ) -> Self {
        let [i, j] = axes_across(k);
        let axes = [i, j, k];
        let [x, y, z] = direction;
        // (Md): of the mixed numbers, each stands at the axis that it does not mix.
        let turned = [
            diagonal[0] * x + (mixed[2] * y + mixed[1] * z),
            diagonal[1] * y + (mixed[2] * x + mixed[0] * z),
            diagonal[2] * z + (mixed[1] * x + mixed[0] * y),
        ];
        let along = x * turned[0] + y * turned[1] + z * turned[2];
        let turned = axes.map(|k| turned[k]);
        let drift = [turned[0] / along, turned[1] / along];
        let form = [
            diagonal[axes[0]] - turned[0] * drift[0],
            mixed[axes[2]] - turned[0] * drift[1],
            diagonal[axes[1]] - turned[1] * drift[1],
        ];
        let determinant = form[0] * form[2] - form[1] * form[1];
        let two = R::from_f64(2.0);
        let spread = drift[0] * drift[0] * form[2] - two * drift[0] * drift[1] * form[1]
            + drift[1] * drift[1] * form[0];
        let kappa = along.sqrt();
        let least = R::from_f64(0.0);
        Self {
            axes,
            origin: axes.map(|k| origin[k]),
            direction: axes.map(|k| direction[k]),
            form,
            drift,
            kappa,
            peak: peak / kappa,
            half_widths: [
                cut * (form[2] / determinant).sqrt(),
                cut * (form[0] / determinant).sqrt(),
            ],
            reach: cut / kappa + cut * (spread / determinant).max(least).sqrt(),
            cut,
        }
    }

    /// Where slice `m` is met.
    pub fn crossing(&self, m: i32) -> R {
        let height = R::from_f64(f64::from(m)) + R::from_f64(0.5);
        (height - self.origin[2]) / self.direction[2]
    }

    /// Where the ray is along and across the slices.
    pub fn at(&self, t: R) -> [R; 3] {
        [0, 1, 2].map(|k| self.origin[k] + t * self.direction[k])
    }

    /// The splat of the voxel that lies so far from the crossing: F, and t* after the crossing; `None` beyond R. Where
    /// rounding may choose a side of R, F is as uncertain as it is large there, which is little.
    pub fn splat(&self, [u, v]: [R; 2]) -> Option<[R; 2]> {
        let two = R::from_f64(2.0);
        let [qii, qij, qjj] = self.form;
        let square = qii * u * u + two * qij * u * v + qjj * v * v;
        let end = self.cut * self.cut;
        let ([low, high], [least, most]) = (square.range(), end.range());
        (low <= most).then(|| {
            let weight = self.peak * (R::from_f64(-0.5) * square).exp();
            let is_within = square.to_f64() <= end.to_f64();
            let weight = either([high <= least, false], is_within, weight, R::from_f64(0.0));
            [weight, self.drift[0] * u + self.drift[1] * v]
        })
    }

    /// The part of a splat before `x` deviations of it along the ray. Where rounding may choose a side of an end, it is as
    /// uncertain as the step there, which is small.
    pub fn before(&self, x: R) -> R {
        let (zero, one) = (R::from_f64(0.0), R::from_f64(1.0));
        if self.is_before(x) {
            return zero;
        }
        if self.is_behind(x) {
            return one;
        }
        let ([low, high], [least, _]) = (x.range(), self.cut.range());
        let [at, cut] = [x, self.cut].map(R::to_f64);
        let tail = tail_of(x.abs());
        let part = either([low > 0.0, high <= 0.0], at > 0.0, one - tail, tail);
        let part = either([low > -least, false], at > -cut, part, zero);
        either([high < least, false], at < cut, part, one)
    }

    /// Whether a splat surely has no part before `x` deviations.
    pub fn is_before(&self, x: R) -> bool {
        x.range()[1] <= -self.cut.range()[1]
    }

    /// Whether it surely has none behind that.
    pub fn is_behind(&self, x: R) -> bool {
        x.range()[0] >= self.cut.range()[1]
    }
}

/// `yes` where it is sure, `no` where that is, else what is chosen, or as well the other.
fn either<R: Real>([is_yes, is_no]: [bool; 2], is_chosen: bool, yes: R, no: R) -> R {
    match is_chosen {
        _ if is_yes => yes,
        _ if is_no => no,
        true => yes.or(no),
        false => no.or(yes),
    }
}

impl Line<f64> {
    /// With a kernel as it is.
    pub fn of_kernel(kernel: &Kernel, k: usize, origin: [f64; 3], direction: [f64; 3]) -> Self {
        let m = kernel.precision;
        let diagonal = [0, 1, 2].map(|k| m.col(k)[k]);
        let mixed = [m.col(1)[2], m.col(0)[2], m.col(0)[1]];
        Self::of(
            diagonal,
            mixed,
            kernel.reach,
            kernel.peak(),
            k,
            origin,
            direction,
        )
    }
}

/// 1 - Phi(x) for x >= 0, by 7.1.26 of Abramowitz & Stegun, whose error function is off by 1.5e-7 at most: with
/// t = 1 / (1 + p x / sqrt(2)), a polynomial of t times e^(-x^2 / 2). CPU reference of `shaders/lib/normal.wgsl`.
fn tail_of<R: Real>(x: R) -> R {
    let number = R::from_f64;
    let t = number(1.0) / (number(1.0) + number(0.231_641_888) * x);
    let sum = number(0.127_414_796)
        + t * (number(-0.142_248_368)
            + t * (number(0.710_706_870_5)
                + t * (number(-0.726_576_013_5) + t * number(0.530_702_714_5))));
    t * sum * (number(-0.5) * (x * x)).exp()
}
