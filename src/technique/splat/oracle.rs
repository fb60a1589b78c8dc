//! Splats in f64, voxel by voxel in any order, all of them: no slices, no ellipses, no window of sheets, and the error
//! function itself. What the shader's loops are held to.

use super::kernel::Kernel;
use glam::{DMat3, DVec3};

/// A ray in voxel space, whose parameter is world length.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs, reason = "the line above says it")]
pub struct Line {
    pub origin: DVec3,
    pub direction: DVec3,
}

/// What of one splat lies along a ray.
#[derive(Clone, Copy, Debug)]
pub struct Footprint {
    /// Its integral along all of the ray.
    pub integral: f64,
    /// Where it is densest.
    pub t: f64,
    /// Its deviation along the ray is 1 over this.
    pub kappa: f64,
    /// Where it ends, in deviations.
    pub reach: f64,
}

impl Footprint {
    /// Of a splat at `center`; `None` where the ray passes farther away than splats reach. Distances are taken from the
    /// point of the ray that is nearest to the centre in the world of voxels.
    pub fn new(kernel: &Kernel, line: &Line, center: DVec3) -> Option<Self> {
        let Kernel { precision, reach } = *kernel;
        let m: DMat3 = precision;
        let d = line.direction;
        let near = d.dot(center - line.origin) / d.length_squared();
        let w = center - (line.origin + near * d);
        let along = d.dot(m * d);
        let behind = d.dot(m * w) / along;
        let square = w.dot(m * w) - behind * behind * along;
        (square <= reach * reach).then(|| Self {
            integral: kernel.peak() / along.sqrt() * (-0.5 * square).exp(),
            t: near + behind,
            kappa: along.sqrt(),
            reach,
        })
    }

    /// What lies before `t`, in parts of the whole.
    pub fn before(&self, t: f64) -> f64 {
        let x = self.kappa * (t - self.t);
        match x {
            _ if x <= -self.reach => 0.0,
            _ if x >= self.reach => 1.0,
            _ => normal(x),
        }
    }

    /// What lies between two places of the ray.
    pub fn between(&self, from: f64, to: f64) -> f64 {
        self.integral * (self.before(to) - self.before(from))
    }
}

/// Sums of `numbers` times what lies between neighbours of `edges`, over all voxels.
pub fn sheets<const N: usize>(
    kernel: &Kernel,
    line: &Line,
    voxels: impl Iterator<Item = (DVec3, [f64; N])>,
    edges: &[f64],
) -> Vec<[f64; N]> {
    let mut sums = vec![[0.0; N]; edges.len() - 1];
    for (center, numbers) in voxels {
        let Some(footprint) = Footprint::new(kernel, line, center) else {
            continue;
        };
        for (sum, ends) in sums.iter_mut().zip(edges.windows(2)) {
            let part = footprint.between(ends[0], ends[1]);
            *sum = std::array::from_fn(|c| sum[c] + part * numbers[c]);
        }
    }
    sums
}

/// The distribution function of the normal distribution. Up to 3 by its series (Abramowitz & Stegun 26.2.11), beyond by
/// the continued fraction of its tail (26.2.14): to 1e-15.
pub fn normal(x: f64) -> f64 {
    let density = (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
    if x.abs() < 3.0 {
        let (mut term, mut sum) = (x, x);
        for k in 1..120 {
            term *= x * x / f64::from(2 * k + 1);
            sum += term;
        }
        return 0.5 + density * sum;
    }
    let y = x.abs();
    let fraction = (1..120).rev().fold(y, |under, k| y + f64::from(k) / under);
    let tail = density / fraction;
    if x > 0.0 { 1.0 - tail } else { tail }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_normal_distribution_is_that_of_tables() {
        // Abramowitz & Stegun, table 26.1.
        for (x, wanted) in [
            (0.0, 0.5),
            (0.5, 0.691_462_461_274_013),
            (1.0, 0.841_344_746_068_543),
            (2.0, 0.977_249_868_051_821),
            (2.9999, 0.998_649_658_740_94),
            (3.0, 0.998_650_101_968_37),
            (4.0, 0.999_968_328_758_167),
        ] {
            assert!((normal(x) - wanted).abs() < 1e-10, "{x}: {}", normal(x));
            assert!((normal(-x) - (1.0 - wanted)).abs() < 1e-10, "{x}");
        }
    }
}
