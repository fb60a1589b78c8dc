//! Noise out of a picture that is the mean of two independent ones: planes through pixels that are alike, by non-local means and
//! by what paths met first (Bitterli et al., "Nonlinearly Weighted First-order Regression for Denoising Monte Carlo Renderings",
//! 2016; weights of Rousselle, Knaus & Zwicker, "Adaptive Rendering with Non-Local Means Filtering", 2012).
//!
//! ```text
//! v     = (a - b)^2 / 2, mean of 3 x 3                         variance of each half
//! g'(p) = mean over both halves of (sum of w g_q / sum of w)     a guide without noise; w: how alike that guide is
//! a'(p) = c_0, where c makes least the sum of w (a_q - c x_q)^2      w: how alike colours are; x_q = (1, q - p, g'_q - g'_p)
//! ```
//!
//! Sums are over q in 15 x 15 around p. Weights by one half ([`patch_weights`]) filter the other, so that what is noise in both is not kept
//! for detail. Guides ([`super::guides`]) say how colours change from pixel to pixel: in a plane over them an edge is as sharp as
//! theirs, and a slope is not washed out ([`fit`]). Colours are filtered twice, fine detail kept or more noise taken out, and what is
//! nearer to the half that it was not made of is chosen ([`choice`]). A picture without noise stays as it is.

mod choice;
mod fit;
mod patch_weights;
mod planes;
mod rows;
mod tiles;

use super::guides::{Compared, Guide, NUMBERS, compared};
use choice::chosen;
use fit::Fits;
use patch_weights::{Comparison, PatchWeights, Shifted};
use planes::{Plane, planes, variance};
use std::ops::Range;
use tiles::{Tile, in_tiles};

const WINDOW: usize = 7;
const SIDE: usize = 2 * WINDOW + 1;
const PATCH: usize = 2;
const TAPS: usize = 2 * PATCH + 1;
/// Beyond the edges lie as many pixels as a window and a patch reach.
const PAD: usize = WINDOW + PATCH;
/// Red, green, blue and alpha.
const COLORS: usize = 4;
/// A constant, two places and the guides.
const UNKNOWNS: usize = 3 + NUMBERS;

/// Colours one by one; fine detail stays, or more noise goes.
const BY_COLORS: [Comparison; 2] = [by_colors(0.5), by_colors(1.0)];

const fn by_colors(strength: f32) -> Comparison {
    Comparison {
        numbers: 0..COLORS,
        together: 1,
        strength,
        least: 1e-10,
    }
}

/// Of one guide, whose numbers count together.
const fn by_guide(numbers: Range<usize>) -> Comparison {
    Comparison {
        together: numbers.end - numbers.start,
        numbers,
        strength: 1.0,
        least: 1e-3,
    }
}

/// Albedo, normal and depth.
const BY_GUIDES: [Comparison; 3] = [by_guide(0..3), by_guide(3..6), by_guide(6..7)];

/// The mean of two pictures of `width` pixels a row, of different paths and as many, without their noise; with what guides
/// each of them.
pub fn denoised(halves: [&[[f32; 4]]; 2], guides: [&[Guide]; 2], width: usize) -> Vec<[f32; 4]> {
    let count = halves[0].len();
    if count == 0 {
        return Vec::new();
    }
    let size = [width, count / width];
    let guides = planes(&filtered_guides(&compared(guides), size), size);
    let variance = variance(halves, size);
    let noisy = Noisy {
        halves,
        planes: halves.map(|half| planes(half, size)),
        variances: planes(&variance, size),
        variance,
        guides,
        size,
    };
    let [fine, smooth] =
        BY_COLORS.map(|comparison| [0, 1].map(|half| noisy.fitted(half, &comparison)));
    chosen(halves, &fine, &smooth, size)
}

/// What is filtered.
struct Noisy<'h> {
    halves: [&'h [[f32; COLORS]]; 2],
    planes: [Vec<Plane>; 2],
    variance: Vec<[f32; COLORS]>,
    variances: Vec<Plane>,
    guides: Vec<Plane>,
    size: [usize; 2],
}

impl Noisy<'_> {
    /// One half, by the other.
    fn fitted(&self, half: usize, comparison: &Comparison) -> Vec<[f32; COLORS]> {
        let weights = PatchWeights {
            values: &self.planes[1 - half],
            variances: &self.variances,
            comparison,
            size: self.size,
        };
        in_tiles(self.size, |tile| {
            // Without noise there is nothing to take out, and a sum would round.
            let is_noisy = |at: usize| self.variance[at] != [0.0; COLORS];
            if !tile.pixels().any(is_noisy) {
                return tile.pixels().map(|at| self.halves[half][at]).collect();
            }
            let fits = fits(&weights, &self.planes[half], &self.guides, tile);
            let filtered = tile.pixels().enumerate().map(|(i, at)| {
                if !is_noisy(at) {
                    return self.halves[half][at];
                }
                let [r, g, b, alpha] = fits.at(i).map(|c| c.max(0.0));
                [r, g, b, alpha.min(1.0)]
            });
            filtered.collect()
        })
    }
}

/// Planes through the colours of a half, for the pixels of a tile.
fn fits(weights: &PatchWeights, of: &[Plane], guides: &[Plane], tile: &Tile) -> Fits {
    let count = tile.columns.len();
    let mut fits = Fits::new(UNKNOWNS, tile.len());
    let mut x = vec![vec![1.0_f32; count]; UNKNOWNS];
    weights.in_windows(tile, |shifted| {
        let [own, other] = rows_of(tile, shifted);
        let place = shifted.shift.map(|n| n as f32 / WINDOW as f32 - 1.0);
        x[1].fill(place[0]);
        x[2].fill(place[1]);
        for (x, guide) in x[3..].iter_mut().zip(guides) {
            let [own, other] = [own, other].map(|[x, y]| guide.row(y, x, count));
            rows::set(x, |n| other[n] - own[n]);
        }
        let [column, row] = other;
        let colors = std::array::from_fn(|c| of[c].row(row, column, count));
        fits.add(shifted.row * count, shifted.weights, &x, colors);
    });
    fits
}

/// Where in planes the pixels of a row begin, and those that are a shift away.
fn rows_of(tile: &Tile, shifted: &Shifted) -> [[usize; 2]; 2] {
    let [x, y] = [tile.columns.start, tile.rows.start + shifted.row];
    let [across, down] = shifted.shift;
    [[x + PAD, y + PAD], [x + across + PATCH, y + down + PATCH]]
}

/// Guides of both halves without noise of their own: g'.
fn filtered_guides(halves: &[Vec<Compared>; 2], size: [usize; 2]) -> Vec<Compared> {
    let variances = planes(&variance([&halves[0], &halves[1]], size), size);
    let planes = halves.each_ref().map(|half| planes(half, size));
    in_tiles(size, |tile| {
        let mut filtered = vec![[0.0; NUMBERS]; tile.len()];
        for (half, by) in [(0, 1), (1, 0)] {
            for comparison in &BY_GUIDES {
                let weights = PatchWeights {
                    values: &planes[by],
                    variances: &variances,
                    comparison,
                    size,
                };
                add_means(&mut filtered, &weights, &planes[half], tile);
            }
        }
        filtered
    })
}

/// Adds half of the weighted means of one guide.
fn add_means(filtered: &mut [Compared], weights: &PatchWeights, of: &[Plane], tile: &Tile) {
    let count = tile.columns.len();
    let numbers = weights.comparison.numbers.clone();
    let mut sums = vec![[0.0_f32; NUMBERS]; tile.len()];
    let mut totals = vec![0.0_f32; tile.len()];
    weights.in_windows(tile, |shifted| {
        let [_, [column, row]] = rows_of(tile, shifted);
        let own = shifted.row * count;
        for (sum, weight) in totals[own..].iter_mut().zip(shifted.weights) {
            *sum += weight;
        }
        for n in numbers.clone() {
            let pairs = shifted.weights.iter().zip(of[n].row(row, column, count));
            for (sum, (weight, other)) in sums[own..].iter_mut().zip(pairs) {
                sum[n] += weight * other;
            }
        }
    });
    for ((pixel, sum), total) in filtered.iter_mut().zip(&sums).zip(&totals) {
        for n in numbers.clone() {
            pixel[n] += 0.5 * sum[n] / total;
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

    /// Smaller than a window and a patch.
    #[test]
    fn pictures_of_few_pixels_are_filtered() {
        for size in [[1, 1], [1, 30], [2, 5], [6, 4], [30, 1]] {
            let count = size[0] * size[1];
            let halves = [1, 2].map(|seed| noisy(seed, 0.3)[..count].to_vec());
            let guides = [3, 4].map(|seed| guides(seed, 0.1, 1.0)[..count].to_vec());
            let found = denoised(
                halves.each_ref().map(|half| &half[..]),
                guides.each_ref().map(|half| &half[..]),
                size[0],
            );
            assert!(
                found.len() == count && found.iter().flatten().all(|c| (0.0..=1.2).contains(c)),
                "{size:?} {found:?}"
            );
        }
    }

    /// A step that only the half has which is filtered: the other one says that all pixels are alike.
    #[test]
    fn one_half_is_filtered_by_the_other() {
        let size = [WIDTH, HEIGHT];
        let red = |i: usize| if i % WIDTH < 20 { 0.0 } else { 1.0 };
        let step: Vec<_> = (0..WIDTH * HEIGHT)
            .map(|i| [red(i), 0.0, 0.0, 1.0])
            .collect();
        let even = vec![[0.5, 0.0, 0.0, 1.0]; WIDTH * HEIGHT];
        let variance = vec![[1e-4; COLORS]; WIDTH * HEIGHT];
        let noisy = Noisy {
            halves: [&step, &even],
            planes: [planes(&step, size), planes(&even, size)],
            variances: planes(&variance, size),
            variance,
            guides: planes(&vec![[0.0; NUMBERS]; WIDTH * HEIGHT], size),
            size,
        };
        // A plane through a window around its middle has the mean there: of 15 columns 7 are beyond the step.
        let found = noisy.fitted(0, &BY_COLORS[0])[15 * WIDTH + 19][0];
        assert!((found - 7.0 / 15.0).abs() < 1e-5, "{found}");
        let unmixed = noisy.fitted(1, &BY_COLORS[0])[15 * WIDTH + 19][0];
        assert!((unmixed - 0.5).abs() < 1e-5, "{unmixed}");
    }

    /// Means of 0 and of 1 are as often below as over that.
    #[test]
    fn no_colour_is_below_0_and_no_alpha_over_1() {
        let halves = [1, 2].map(|seed| -> Vec<[f32; 4]> {
            let numbers =
                (0..(WIDTH * HEIGHT) as u32).map(|i| random_numbers::<f32>([i, seed, 0, 0]));
            let around = |[r, g, b, a]: [f32; 4]| [r - 0.5, g - 0.5, b - 0.5, a + 0.5];
            numbers.map(around).collect()
        });
        let none = none();
        let found = denoised([&halves[0], &halves[1]], [&none; 2], WIDTH);
        for [r, g, b, alpha] in found {
            assert!(
                r.min(g).min(b) >= 0.0 && alpha <= 1.0,
                "{r} {g} {b} {alpha}"
            );
        }
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
            numbers
                .map(|[r, g, b, alpha]| [r + 1.0, g + 1.0, b + 1.0, alpha])
                .collect()
        };
        let halves = [1, 2].map(even);
        // Guides with noise of their own, of which colours know nothing.
        let guide = |n: &[f32; 4]| [[n[2], n[0], n[3], 1.0], [n[1], n[3], 0.0, n[0]]];
        let guides = [3, 4]
            .map(even)
            .map(|half| half.iter().map(guide).collect::<Vec<_>>());
        let found = denoised([&halves[0], &halves[1]], [&guides[0], &guides[1]], 64);
        for (c, wanted) in [1.5, 1.5, 1.5, 0.5].into_iter().enumerate() {
            let mean = found.iter().map(|p| f64::from(p[c])).sum::<f64>() / 4096.0;
            // Of 8192 even numbers, four standard errors.
            assert!(
                (mean - wanted).abs() < 4.0 * (1.0 / 12.0_f64 / 8192.0).sqrt(),
                "{mean}"
            );
        }
    }
}
