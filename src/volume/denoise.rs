//! Noise taken out of a volume before it is projected: noise alone lifts a maximum, by more than three times its
//! deviation along 512 samples. CPU reference of `shaders/denoise.wgsl` and of its kernels.
//!
//! ```text
//! gaussian    sum of w(|k|) f(x + k),  w ~ exp(-k^2 / 2 s^2), along x, then y, then z
//! median      the fourteenth of the 27 numbers around a voxel
//! bilateral   f(x) + sum of g d / sum of g,   d = f(y) - f(x),   g = w(y - x) exp(-d^2 / 2 r^2)
//! nlm         the same with g = exp(-D / 2 s^2),  D the mean of (f(y + k) - f(x + k))^2 over the 27 k around
//! ```
//!
//! Tomasi and Manduchi, "Bilateral Filtering for Gray and Color Images", ICCV 1998. Buades, Coll and Morel, "A
//! Non-local Algorithm for Image Denoising", CVPR 2005: y goes over the 7^3 voxels around, s is the deviation of the
//! noise (as Coupe et al., IEEE TMI 27(4), 2008, choose the strength), and x itself weighs what the most alike of the
//! others does. White noise of deviation 1 is left with (2 s sqrt pi)^(-3/2) by the Gaussian, 0.114 at s = 1.2 voxels.
//! All of them work on stored numbers, the Gaussian as far as four deviations and the bilateral filter as far as two,
//! and take the nearest voxel for those outside. No data stays no data; what is stored there, the nearest valid number,
//! is seen by its neighbours. Thin bright things lose height as well.

use super::{Rescale, Volume, Voxels};
use crate::shaders::MAX_DENOISE_WEIGHTS;

/// A noise filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Denoise {
    /// Blurs all alike.
    Gaussian {
        /// Deviation in voxels, the same along each axis.
        sigma_voxels: f64,
    },
    /// Takes out lone outliers and keeps edges.
    Median,
    /// Blurs what is alike and keeps edges that stand out of the noise.
    Bilateral {
        /// Deviation in voxels.
        sigma_voxels: f64,
        /// Deviation in values; `None`: twice that of the noise, as [`noise_of`] estimates it.
        sigma_value: Option<f64>,
    },
    /// Non-local means: averages places that look alike, each with the voxels around it.
    NonLocalMeans {
        /// Deviation of the noise in values; `None`: as [`noise_of`] estimates it.
        sigma_value: Option<f64>,
    },
}

/// The largest deviation whose kernel has room.
pub const MAX_SIGMA_VOXELS: f64 = (MAX_DENOISE_WEIGHTS as f64 - 1.0) / DEVIATIONS;

/// How far a Gaussian reaches.
const DEVIATIONS: f64 = 4.0;
/// How far the other one does: its cost grows with the cube.
const BILATERAL_DEVIATIONS: f64 = 2.0;

/// How far alike places are looked for, and a patch of 3^3 voxels beyond.
const NLM_RADIUS: u32 = 4;
/// Voxels of a patch.
const PATCH: f64 = 27.0;

/// What a pass needs to know.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pass {
    /// Part of the shader's name.
    pub kernel: &'static str,
    /// Of a pass in one direction.
    pub axis: u32,
    /// Voxels to each side.
    pub radius: u32,
    /// Of each distance.
    pub weights: [f32; MAX_DENOISE_WEIGHTS as usize],
    /// 1 / (2 r^2) in stored numbers.
    pub difference_factor: f32,
}

impl Denoise {
    /// The passes over a volume, one after the other; none where nothing is to be done.
    pub fn passes(&self, volume: &Volume) -> Vec<Pass> {
        let pass = |kernel, axis, radius, weights, difference_factor| Pass {
            kernel,
            axis,
            radius,
            weights,
            difference_factor,
        };
        match *self {
            Self::Gaussian { sigma_voxels } => {
                let (radius, weights) = gaussian(sigma_voxels, DEVIATIONS);
                [0, 1, 2]
                    .map(|axis| pass("gaussian", axis, radius, weights, 0.0))
                    .to_vec()
            }
            Self::Median => vec![pass("median", 0, 1, [0.0; 32], 0.0)],
            Self::Bilateral {
                sigma_voxels,
                sigma_value,
            } => {
                let sigma_value = sigma_value.unwrap_or_else(|| 2.0 * noise_of(volume));
                let sigma_stored = sigma_value / volume.rescale.slope.abs();
                let factor = (0.5 / (sigma_stored * sigma_stored)) as f32;
                // Numbers without noise are left as they are.
                if !factor.is_finite() {
                    return Vec::new();
                }
                let (radius, weights) = gaussian(sigma_voxels, BILATERAL_DEVIATIONS);
                vec![pass("bilateral", 0, radius, weights, factor)]
            }
            Self::NonLocalMeans { sigma_value } => {
                let sigma_value = sigma_value.unwrap_or_else(|| noise_of(volume));
                let sigma_stored = sigma_value / volume.rescale.slope.abs();
                // Of the sum over a patch.
                let factor = (0.5 / (PATCH * sigma_stored * sigma_stored)) as f32;
                if !factor.is_finite() {
                    return Vec::new();
                }
                vec![pass("nlm", 0, NLM_RADIUS, [0.0; 32], factor)]
            }
        }
    }

    /// The volume without noise, on the CPU.
    pub fn denoised(&self, volume: &Volume) -> Volume {
        let mut numbers: Vec<f32> = (0..volume.voxels.len())
            .map(|i| volume.voxels.stored(i))
            .collect();
        let dims = volume.dims.map(|n| n as usize);
        for pass in self.passes(volume) {
            numbers = pass.run(dims, &numbers);
        }
        with_numbers(volume, numbers)
    }
}

/// The volume with other stored numbers.
pub fn with_numbers(volume: &Volume, numbers: Vec<f32>) -> Volume {
    let is_valid = |i: usize| volume.validity.as_ref().is_none_or(|mask| mask[i] != 0);
    let Rescale { slope, intercept } = volume.rescale;
    let valid = numbers.iter().enumerate().filter(|(i, _)| is_valid(*i));
    let range = valid.fold(None, |range: Option<[f32; 2]>, (_, &number)| {
        let [low, high] = range.unwrap_or([number; 2]);
        Some([low.min(number), high.max(number)])
    });
    let ends = range.unwrap_or([0.0; 2]);
    let value = |stored: f32| f64::from(stored) * slope + intercept;
    let [a, b] = ends.map(value);
    Volume {
        voxels: Voxels::F32(numbers),
        value_range: if range.is_some() {
            [a.min(b), a.max(b)]
        } else {
            [0.0; 2]
        },
        validity: volume.validity.clone(),
        unit: volume.unit.clone(),
        ..*volume
    }
}

/// The deviation of noise in values: that of differences between neighbours along x, over the root of two, estimated
/// by the median of those that are not 0 (air and padding have no noise). 0 where all neighbours are alike.
pub fn noise_of(volume: &Volume) -> f64 {
    /// So many pairs are enough for three digits.
    const PAIRS: usize = 1 << 20;
    /// The median of |d| of a normal distribution, in deviations.
    const MEDIAN: f64 = 0.674_489_75;
    let width = volume.dims[0] as usize;
    let count = volume.voxels.len();
    let step = (count / PAIRS).max(1);
    let difference = |i: usize| {
        let is_pair = !(i + 1).is_multiple_of(width);
        let valid = |i: usize| volume.validity.as_ref().is_none_or(|mask| mask[i] != 0);
        let both = is_pair && valid(i) && valid(i + 1);
        both.then(|| (volume.voxels.stored(i + 1) - volume.voxels.stored(i)).abs())
    };
    let mut found: Vec<f32> = (0..count)
        .step_by(step)
        .filter_map(difference)
        .filter(|&d| d > 0.0)
        .collect();
    if found.is_empty() {
        return 0.0;
    }
    let middle = found.len() / 2;
    let (_, median, _) = found.select_nth_unstable_by(middle, f32::total_cmp);
    f64::from(*median) / (MEDIAN * 2_f64.sqrt()) * volume.rescale.slope.abs()
}

/// Reach and weights of a Gaussian that sums to one along an axis.
fn gaussian(sigma_voxels: f64, deviations: f64) -> (u32, [f32; MAX_DENOISE_WEIGHTS as usize]) {
    let sigma = sigma_voxels.clamp(1e-3, MAX_SIGMA_VOXELS);
    let radius = (deviations * sigma).ceil() as u32;
    let weight = |k: u32| (-0.5 * (f64::from(k) / sigma).powi(2)).exp();
    let sum: f64 = weight(0) + 2.0 * (1..=radius).map(weight).sum::<f64>();
    let mut weights = [0.0; MAX_DENOISE_WEIGHTS as usize];
    for (k, place) in (0..=radius).zip(&mut weights) {
        *place = (weight(k) / sum) as f32;
    }
    (radius, weights)
}

impl Pass {
    /// One pass on the CPU, slices shared out among the machine's cores.
    fn run(&self, dims: [usize; 3], numbers: &[f32]) -> Vec<f32> {
        let slice = dims[0] * dims[1];
        let threads = std::thread::available_parallelism().map_or(1, |n| n.get());
        let slices_each = dims[2].div_ceil(threads).max(1);
        let mut filtered = vec![0.0; numbers.len()];
        std::thread::scope(|scope| {
            for (part, out) in filtered.chunks_mut(slice * slices_each).enumerate() {
                let grid = Slices { dims, numbers };
                scope.spawn(move || {
                    for (i, number) in out.iter_mut().enumerate() {
                        let (z, rest) = (part * slices_each + i / slice, i % slice);
                        let index = [rest % dims[0], rest / dims[0], z].map(|n| n as i64);
                        *number = self.filtered(&grid, index);
                    }
                });
            }
        });
        filtered
    }

    fn filtered(&self, grid: &Slices, index: [i64; 3]) -> f32 {
        match self.kernel {
            "gaussian" => self.along(grid, index),
            "median" => median(grid, index),
            "nlm" => self.non_local(grid, index),
            _ => self.bilateral(grid, index),
        }
    }

    fn along(&self, grid: &Slices, index: [i64; 3]) -> f32 {
        let at = |k: i64| {
            let mut index = index;
            index[self.axis as usize] += k;
            grid.number_at(index)
        };
        (1..=self.radius as usize).fold(self.weights[0] * at(0), |sum, k| {
            sum + self.weights[k] * (at(-(k as i64)) + at(k as i64))
        })
    }

    fn bilateral(&self, grid: &Slices, [x, y, z]: [i64; 3]) -> f32 {
        let here = grid.number_at([x, y, z]);
        let reach = i64::from(self.radius);
        let weight_of = |k: i64| self.weights[k.unsigned_abs() as usize];
        let (mut sum, mut weights) = (0.0, 0.0);
        for k in -reach..=reach {
            for j in -reach..=reach {
                for i in -reach..=reach {
                    let difference = grid.number_at([x + i, y + j, z + k]) - here;
                    let near = weight_of(i) * weight_of(j) * weight_of(k);
                    let weight = near * (-difference * difference * self.difference_factor).exp();
                    sum += weight * difference;
                    weights += weight;
                }
            }
        }
        here + sum / weights
    }
}

impl Pass {
    /// How many numbers a voxel is made of: what a dispatch costs.
    pub fn fetches(&self) -> u64 {
        let across = |reach: u32| 2 * u64::from(reach) + 1;
        match self.kernel {
            "gaussian" => across(self.radius),
            "nlm" => across(self.radius - 1).pow(3) * PATCH as u64,
            // Twenty-seven, each put into its place.
            "median" => 27 * 14,
            _ => across(self.radius).pow(3),
        }
    }

    fn non_local(&self, grid: &Slices, [x, y, z]: [i64; 3]) -> f32 {
        let patch = |[x, y, z]: [i64; 3]| -> [f32; 27] {
            std::array::from_fn(|i| {
                let i = i as i64;
                grid.number_at([x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1])
            })
        };
        let own = patch([x, y, z]);
        let here = grid.number_at([x, y, z]);
        let reach = i64::from(self.radius) - 1;
        let (mut sum, mut weights, mut largest) = (0.0, 0.0, 0.0_f32);
        for k in -reach..=reach {
            for j in -reach..=reach {
                for i in -reach..=reach {
                    if [i, j, k] == [0; 3] {
                        continue;
                    }
                    let there = [x + i, y + j, z + k];
                    let pairs = patch(there).into_iter().zip(own);
                    let apart = pairs.fold(0.0, |sum, (a, b)| sum + (a - b) * (a - b));
                    let weight = (-apart * self.difference_factor).exp();
                    sum += weight * (grid.number_at(there) - here);
                    weights += weight;
                    largest = largest.max(weight);
                }
            }
        }
        // Where nothing is alike the number stays.
        if largest == 0.0 {
            return here;
        }
        here + sum / (weights + largest)
    }
}

fn median(grid: &Slices, [x, y, z]: [i64; 3]) -> f32 {
    let around = |i: i64| [x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1];
    let mut all: [f32; 27] = std::array::from_fn(|i| grid.number_at(around(i as i64)));
    let (_, median, _) = all.select_nth_unstable_by(13, f32::total_cmp);
    *median
}

/// Numbers on a grid, x fastest.
struct Slices<'a> {
    dims: [usize; 3],
    numbers: &'a [f32],
}

impl Slices<'_> {
    fn number_at(&self, index: [i64; 3]) -> f32 {
        let [x, y, z]: [usize; 3] =
            std::array::from_fn(|k| index[k].clamp(0, self.dims[k] as i64 - 1) as usize);
        self.numbers[x + self.dims[0] * (y + self.dims[1] * z)]
    }
}
