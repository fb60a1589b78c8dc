//! Noise out of a picture that is the mean of two independent ones, by non-local means (Buades et al. 2005) in the form of
//! Rousselle, Knaus & Zwicker, "Adaptive Rendering with Non-Local Means Filtering", 2012, with guides (2013: "Robust Denoising
//! using Feature and Color Buffers").
//!
//! ```text
//! v     = (a - b)^2 / 2, mean of 3 x 3                         variance of each half
//! d^2   = mean over 5 x 5 and channels of ((b_p - b_q)^2 - (v_p + min(v_p, v_q))) / (eps + k^2 (v_p + v_q))
//! D^2   = max(0, d^2) + sum over guides of max(0, their d^2)      of which both sides of the line count all numbers together
//! a'(p) = sum over 15 x 15 of w a_q / sum of w                 w = exp(-D^2) by the other half
//! ```
//!
//! Weights by one half filter the other, so that what is noise in both is not kept for detail. A picture without noise stays
//! as it is. Guides ([`super::guides`]) keep apart what is lit alike and is not the same; with them colours may differ by more.

use super::guides::{Guide, compared};
use std::ops::Range;

const WINDOW: usize = 7;
const SIDE: usize = 2 * WINDOW + 1;
const PATCH: usize = 2;
const TAPS: usize = 2 * PATCH + 1;
/// Pixels farther apart have no weight: it would be a thousandth.
const MOST_APART: f32 = 6.9;

/// Numbers of a pixel whose differences are added before they are compared with their variances.
struct Together {
    /// Which ones: colours and alpha are 0 to 3, then come those of [`Compared`](super::guides::Compared).
    numbers: Range<usize>,
    /// To which distance they belong: that of colours or of a guide.
    feature: usize,
    weight: f32,
    /// How far pixels may differ, in standard deviations of their difference.
    strength: f32,
    /// Squares of differences that are none.
    least: f32,
}

/// How far pixels are apart by their colours and by each guide.
const FEATURES: usize = 4;

const TOGETHER: [Together; 7] = [
    color(0),
    color(1),
    color(2),
    color(3),
    guide(1, 4..7),
    guide(2, 7..10),
    guide(3, 10..11),
];

const fn color(channel: usize) -> Together {
    Together {
        numbers: channel..channel + 1,
        feature: 0,
        weight: 0.25,
        strength: 0.6,
        least: 1e-10,
    }
}

const fn guide(feature: usize, numbers: Range<usize>) -> Together {
    Together {
        numbers,
        feature,
        weight: 1.0,
        strength: 1.5,
        least: 1e-3,
    }
}

/// The mean of two pictures of `width` pixels a row, of different paths and as many, without their noise; with what guides
/// each of them.
pub fn denoised(halves: [&[[f32; 4]]; 2], guides: [&[Guide]; 2], width: usize) -> Vec<[f32; 4]> {
    let [a, b] = halves;
    let height = a.len() / width.max(1);
    if a.is_empty() {
        return Vec::new();
    }
    let size = [width, height];
    let guides = compared(guides);
    let variance_of_guides = variance([&guides[0], &guides[1]], size);
    let variance = variance(halves, size);
    let by = [0, 1].map(|half| By {
        values: [planes(halves[half], size), planes(&guides[half], size)].concat(),
        variances: [planes(&variance, size), planes(&variance_of_guides, size)].concat(),
        width,
        height,
    });
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let rows = height.div_ceil(threads).max(1);
    let mut picture = vec![[0.0; 4]; a.len()];
    std::thread::scope(|scope| {
        for (i, band) in picture.chunks_mut(rows * width).enumerate() {
            let (by, variance) = (&by, &variance);
            scope.spawn(move || {
                by[1].add_filtered(a, variance, i * rows, band);
                by[0].add_filtered(b, variance, i * rows, band);
            });
        }
    });
    picture
}

/// Of each half, per number.
fn variance<const N: usize>(
    [a, b]: [&[[f32; N]]; 2],
    [width, height]: [usize; 2],
) -> Vec<[f32; N]> {
    let of = |x: usize, y: usize| {
        let (a, b) = (a[y * width + x], b[y * width + x]);
        std::array::from_fn(|c| 0.5 * (a[c] - b[c]).powi(2))
    };
    let mean = |at: usize| {
        let (x, y) = (at % width, at / width);
        let (xs, ys) = (
            x.saturating_sub(1)..=(x + 1).min(width - 1),
            y.saturating_sub(1)..=(y + 1).min(height - 1),
        );
        let count = (xs.clone().count() * ys.clone().count()) as f32;
        let all = ys.flat_map(|y| xs.clone().map(move |x| (x, y)));
        let sum = all.fold([0.0; N], |sum: [f32; N], (x, y)| {
            let one: [f32; N] = of(x, y);
            std::array::from_fn(|c| sum[c] + one[c])
        });
        sum.map(|s| s / count)
    };
    (0..width * height).map(mean).collect()
}

/// Beyond the edges lie as many pixels as a window and a patch reach.
const PAD: usize = WINDOW + PATCH;

/// One number of each pixel, with edges around the picture that repeat its own: rows of them are compared at once.
#[derive(Clone)]
struct Plane {
    numbers: Vec<f32>,
    stride: usize,
}

fn planes<const N: usize>(picture: &[[f32; N]], size: [usize; 2]) -> Vec<Plane> {
    (0..N).map(|n| Plane::of(picture, n, size)).collect()
}

impl Plane {
    fn of<const N: usize>(picture: &[[f32; N]], n: usize, [width, height]: [usize; 2]) -> Self {
        let held = |i: usize, side: usize| i.saturating_sub(PAD).min(side - 1);
        let rows = 0..height + 2 * PAD;
        let row = |y: usize| &picture[held(y, height) * width..][..width];
        let stride = width + 2 * PAD;
        let numbers = rows.flat_map(|y| (0..stride).map(move |x| row(y)[held(x, width)][n]));
        Self {
            numbers: numbers.collect(),
            stride,
        }
    }

    /// Of a row of the picture with so many pixels before its first, that many and more.
    fn row(&self, y: usize, before: usize, count: usize) -> &[f32] {
        &self.numbers[y * self.stride + before..][..count]
    }
}

/// What weights are made of: numbers and their variances.
struct By {
    values: Vec<Plane>,
    variances: Vec<Plane>,
    width: usize,
    height: usize,
}

impl By {
    /// Adds half of the filtered picture to the rows from `first` on.
    fn add_filtered(
        &self,
        of: &[[f32; 4]],
        variance: &[[f32; 4]],
        first: usize,
        band: &mut [[f32; 4]],
    ) {
        let width = self.width;
        let rows = band.len() / width;
        let mut sums = vec![[0.0_f32; 4]; band.len()];
        let mut weights = vec![0.0_f32; band.len()];
        // Of each row the distances by each feature, one behind the other.
        let mut in_rows = vec![0.0_f32; (rows + 2 * PATCH) * FEATURES * width];
        let mut in_patches = vec![0.0_f32; FEATURES * width];
        let mut apart = Apart::new(width + 2 * PATCH);
        for shift in 0..SIDE * SIDE {
            let [across, down] = [shift % SIDE, shift / SIDE];
            for (y, sums) in in_rows.chunks_mut(FEATURES * width).enumerate() {
                self.compare(first + y, [across, down], &mut apart);
                apart.sum_over_patches(sums);
            }
            for y in 0..rows {
                // Shifts count from one window before.
                let other_y = first + y + down;
                if other_y < WINDOW || other_y >= self.height + WINDOW {
                    continue;
                }
                let other = &of[(other_y - WINDOW) * width..][..width];
                in_patches.fill(0.0);
                let patches = in_rows[y * FEATURES * width..].chunks(FEATURES * width);
                for row in patches.take(TAPS) {
                    for (sum, distance) in in_patches.iter_mut().zip(row) {
                        *sum += distance;
                    }
                }
                let seen = WINDOW.saturating_sub(across)..width.min(width + WINDOW - across);
                for x in seen {
                    let [color, albedo, normal, depth] =
                        [0, 1, 2, 3].map(|f| in_patches[f * width + x].max(0.0));
                    let apart = ((color + albedo) + (normal + depth)) / (TAPS * TAPS) as f32;
                    if apart > MOST_APART {
                        continue;
                    }
                    let weight = (-apart).exp();
                    let (own, other) = (y * width + x, other[x + across - WINDOW]);
                    let sum = &mut sums[own];
                    *sum = [0, 1, 2, 3].map(|c| sum[c] + weight * other[c]);
                    weights[own] += weight;
                }
            }
        }
        for (i, pixel) in band.iter_mut().enumerate() {
            // Without noise there is nothing to take out, and a mean would round.
            let is_exact = variance[first * width + i] == [0.0; 4];
            for c in 0..4 {
                let filtered = match is_exact {
                    true => of[first * width + i][c],
                    false => sums[i][c] / weights[i],
                };
                pixel[c] += 0.5 * filtered;
            }
        }
    }

    /// How far each pixel of row `y`, from [`PATCH`] rows and columns before the picture on, is from the one a shift away.
    fn compare(&self, y: usize, [across, down]: [usize; 2], apart: &mut Apart) {
        let count = self.width + 2 * PATCH;
        apart.by_feature.fill(0.0);
        for together in &TOGETHER {
            apart.clear();
            for n in together.numbers.clone() {
                let [values, variances] = [&self.values[n], &self.variances[n]].map(|plane| {
                    let own = plane.row(y + WINDOW, WINDOW, count);
                    [own, plane.row(y + down, across, count)]
                });
                apart.add(values, variances);
            }
            apart.divide(together);
        }
    }
}

/// Differences of the pixels of a row.
struct Apart {
    /// Squares beyond what variances explain, and the variances.
    above: Vec<f32>,
    below: Vec<f32>,
    /// Of all pixels by each feature, one feature behind the other.
    by_feature: Vec<f32>,
}

impl Apart {
    fn new(count: usize) -> Self {
        let none = vec![0.0; count];
        Self {
            above: none.clone(),
            below: none,
            by_feature: vec![0.0; FEATURES * count],
        }
    }

    fn clear(&mut self) {
        self.above.fill(0.0);
        self.below.fill(0.0);
    }

    fn add(&mut self, [p, q]: [&[f32]; 2], [v, w]: [&[f32]; 2]) {
        let count = self.above.len();
        let (p, q, v, w) = (&p[..count], &q[..count], &v[..count], &w[..count]);
        let (above, below) = (&mut self.above[..count], &mut self.below[..count]);
        for i in 0..count {
            above[i] += (p[i] - q[i]) * (p[i] - q[i]) - (v[i] + v[i].min(w[i]));
            below[i] += v[i] + w[i];
        }
    }

    fn divide(&mut self, together: &Together) {
        let count = self.above.len();
        let of_feature = &mut self.by_feature[together.feature * count..][..count];
        let strength = together.strength * together.strength;
        for ((sum, above), below) in of_feature.iter_mut().zip(&self.above).zip(&self.below) {
            *sum += together.weight * (above / (together.least + strength * below));
        }
    }

    /// The sums over rows of patches, of each pixel of the picture.
    fn sum_over_patches(&self, sums: &mut [f32]) {
        let count = self.above.len();
        let width = count - 2 * PATCH;
        for (sums, apart) in sums.chunks_mut(width).zip(self.by_feature.chunks(count)) {
            for (x, sum) in sums.iter_mut().enumerate() {
                *sum = apart[x..x + TAPS].iter().sum();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::random_numbers;
    use super::*;

    const WIDTH: usize = 40;
    const HEIGHT: usize = 31;

    /// A square on a ground, with even noise of this width.
    fn noisy(seed: u32, noise: f32) -> Vec<[f32; 4]> {
        let pixel = |i: usize| {
            let (x, y) = (i % WIDTH, i / WIDTH);
            let is_in = (10..25).contains(&x) && (8..20).contains(&y);
            let base = if is_in {
                [0.8, 0.4, 0.2, 1.0]
            } else {
                [0.1, 0.1, 0.3, 1.0]
            };
            let numbers = random_numbers::<f32>([i as u32, seed, 0, 0]);
            [0, 1, 2, 3].map(|c| {
                base[c]
                    + if c < 3 {
                        noise * (numbers[c] - 0.5)
                    } else {
                        0.0
                    }
            })
        };
        (0..WIDTH * HEIGHT).map(pixel).collect()
    }

    fn error(picture: &[[f32; 4]]) -> f64 {
        let truth = noisy(0, 0.0);
        let pairs = picture.iter().zip(&truth);
        let squares = pairs.flat_map(|(a, b)| [0, 1, 2].map(|c| f64::from(a[c] - b[c]).powi(2)));
        (squares.sum::<f64>() / (3 * truth.len()) as f64).sqrt()
    }

    /// Guides that say nothing.
    fn none() -> Vec<Guide> {
        vec![[[0.0; 4]; 2]; WIDTH * HEIGHT]
    }

    fn mean([a, b]: [&[[f32; 4]]; 2]) -> Vec<[f32; 4]> {
        let pairs = a.iter().zip(b);
        pairs
            .map(|(a, b)| [0, 1, 2, 3].map(|c| 0.5 * (a[c] + b[c])))
            .collect()
    }

    #[test]
    fn what_noise_explains_is_not_apart() {
        let numbers = [[0.5_f32; 1], [0.7; 1]];
        for together in &TOGETHER {
            // Each number is apart by its standard deviation, and by five of them.
            let [even, clear] = [0.02_f32, 0.0008].map(|variance| {
                let mut apart = Apart::new(1);
                for _ in together.numbers.clone() {
                    apart.add([&numbers[0], &numbers[1]], [&[variance]; 2]);
                }
                apart.divide(together);
                apart.by_feature[together.feature] / together.weight
            });
            assert!(even <= 0.0 && clear > 5.0, "{even} {clear}");
        }
    }

    #[test]
    fn noise_falls_and_edges_stay() {
        let halves = [1, 2].map(|seed| noisy(seed, 0.3));
        let (halves, none) = ([&halves[0][..], &halves[1]], none());
        let found = denoised(halves, [&none; 2], WIDTH);
        let (before, after) = (error(&mean(halves)), error(&found));
        assert!(after < 0.35 * before, "{before} {after}");
    }

    #[test]
    fn a_picture_without_noise_stays_as_it_is() {
        let picture = noisy(0, 0.0);
        // Whatever its guides say.
        let guides = [3, 4].map(|seed| guides(seed, 0.2, 1.0));
        assert_eq!(
            denoised([&picture, &picture], [&guides[0], &guides[1]], WIDTH),
            picture
        );
        let none = none();
        assert_eq!(denoised([&picture, &picture], [&none; 2], WIDTH), picture);
    }

    /// The square of [`noisy`] by its albedo, its normal and its depth, each as much as this, with even noise of this width.
    fn guides(seed: u32, noise: f32, contrast: f32) -> Vec<Guide> {
        let pixel = |i: usize| {
            let (x, y) = (i % WIDTH, i / WIDTH);
            let is_in = (10..25).contains(&x) && (8..20).contains(&y);
            let base = if is_in { contrast } else { 0.0 };
            let numbers = random_numbers::<f32>([i as u32, seed, 0, 7]);
            let [r, g, b, d] = numbers.map(|n| noise * (n - 0.5));
            let albedo = [0.3 + 0.5 * base + r, 0.4 + g, 0.5 + b, 1.0];
            [albedo, [0.0, base, 1.0 - base, 50.0 + 3.0 * base + d]]
        };
        (0..WIDTH * HEIGHT).map(pixel).collect()
    }

    /// A step that noise hides in the colours: guides keep it, all of them together and each by itself, and without them it is
    /// washed out.
    #[test]
    fn guides_keep_a_step_that_colours_hide() {
        // Twice as much noise as the step is high in its strongest colour.
        let halves = [1, 2].map(|seed| noisy(seed, 1.4));
        let halves = [&halves[0][..], &halves[1]];
        let of = |keep: &dyn Fn(Guide) -> Guide| {
            let own = [3, 4].map(|seed| guides(seed, 0.1, 1.0));
            let own = own.map(|half| half.into_iter().map(keep).collect::<Vec<_>>());
            denoised(halves, [&own[0], &own[1]], WIDTH)
        };
        // Red three pixels on either side of the edge: .8 and .1.
        let red = |picture: &[[f32; 4]], columns: std::ops::Range<usize>| {
            let all = (10..18).flat_map(|y| columns.clone().map(move |x| y * WIDTH + x));
            all.map(|i| picture[i][0]).sum::<f32>() / (8 * columns.len()) as f32
        };
        let step = |picture: &[[f32; 4]]| red(picture, 10..13) - red(picture, 7..10);
        let [albedo, rest] = [[0.5, 0.5, 0.5, 1.0], [0.0, 0.0, 1.0, 50.0]];
        let without = of(&|_| [albedo, rest]);
        let before = error(&mean(halves));
        // Less than half of it is left.
        assert!(step(&without) < 0.35, "{}", step(&without));
        // Of 24 pixels with noise of .29 the mean has a standard error of .06, and the step is of two of them.
        let four_errors = 4.0 * 2.0_f32.sqrt() * 0.29 / 24.0_f32.sqrt();
        let kinds: [&dyn Fn(Guide) -> Guide; 4] = [
            &|guide| guide,
            &|[own, _]| [own, rest],
            &|[_, [x, y, z, _]]| [albedo, [x, y, z, 50.0]],
            &|[_, [.., depth]]| [albedo, [0.0, 0.0, 1.0, depth]],
        ];
        for kind in kinds {
            let with = of(kind);
            println!("{} {} {}", step(&with), error(&with), error(&without));
            assert!((step(&with) - 0.7).abs() < four_errors, "{}", step(&with));
            // And noise falls as much.
            assert!(error(&with) < 0.35 * before, "{}", error(&with));
        }
    }

    #[test]
    fn the_mean_of_an_even_picture_stays() {
        let even = |seed: u32| -> Vec<[f32; 4]> {
            let numbers = (0..4096).map(|i| random_numbers::<f32>([i, seed, 0, 0]));
            numbers.map(|n| n.map(|n| n + 1.0)).collect()
        };
        let halves = [1, 2].map(even);
        // Guides with noise of their own, of which colours know nothing.
        let guide = |n: &[f32; 4]| [[n[2], n[0], n[3], 1.0], [n[1], n[3], 0.0, n[0]]];
        let guides = [3, 4]
            .map(even)
            .map(|half| half.iter().map(guide).collect::<Vec<_>>());
        let found = denoised([&halves[0], &halves[1]], [&guides[0], &guides[1]], 64);
        for c in 0..4 {
            let mean = found.iter().map(|p| f64::from(p[c])).sum::<f64>() / 4096.0;
            // Of 8192 even numbers, four standard errors.
            assert!(
                (mean - 1.5).abs() < 4.0 * (1.0 / 12.0_f64 / 8192.0).sqrt(),
                "{mean}"
            );
        }
    }
}
