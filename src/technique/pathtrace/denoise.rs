//! Noise out of a picture that is the mean of two independent ones, by non-local means (Buades et al. 2005) in the form of
//! Rousselle, Knaus & Zwicker, "Adaptive Rendering with Non-Local Means Filtering", 2012.
//!
//! ```text
//! v     = (a - b)^2 / 2, mean of 3 x 3                         variance of each half
//! d^2   = mean over 5 x 5 and channels of ((b_p - b_q)^2 - (v_p + min(v_p, v_q))) / (eps + k^2 (v_p + v_q))
//! a'(p) = sum over 15 x 15 of w a_q / sum of w                 w = exp(-max(0, d^2)) by the other half
//! ```
//!
//! Weights by one half filter the other, so that what is noise in both is not kept for detail. A picture without noise stays
//! as it is.

const WINDOW: i32 = 7;
const PATCH: i32 = 2;
/// How far pixels may differ, in standard deviations of their difference.
const STRENGTH: f32 = 0.45;
const LEAST: f32 = 1e-10;
/// Weights under this are none.
const LEAST_WEIGHT: f32 = 1e-3;

/// The mean of two pictures of `width` pixels a row, of different paths and as many, without their noise.
pub fn denoised(halves: [&[[f32; 4]]; 2], width: usize) -> Vec<[f32; 4]> {
    let [a, b] = halves;
    let height = a.len() / width.max(1);
    let variance = variance(halves, width, height);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let rows = height.div_ceil(threads).max(1);
    let mut picture = vec![[0.0; 4]; a.len()];
    std::thread::scope(|scope| {
        for (i, band) in picture.chunks_mut((rows * width).max(1)).enumerate() {
            let (variance, first) = (&variance, i * rows);
            scope.spawn(move || {
                let filter = |of: &[[f32; 4]], by: &[[f32; 4]], band: &mut [[f32; 4]]| {
                    let by = By {
                        colors: by,
                        variance,
                        width: width as i32,
                        height: height as i32,
                    };
                    by.add_filtered(of, first as i32, band);
                };
                filter(a, b, band);
                filter(b, a, band);
            });
        }
    });
    picture
}

/// Of each half, per channel.
fn variance([a, b]: [&[[f32; 4]]; 2], width: usize, height: usize) -> Vec<[f32; 4]> {
    let of = |x: usize, y: usize| {
        let (a, b) = (a[y * width + x], b[y * width + x]);
        [0, 1, 2, 3].map(|c| 0.5 * (a[c] - b[c]).powi(2))
    };
    let mean = |at: usize| {
        let (x, y) = (at % width, at / width);
        let (xs, ys) = (
            x.saturating_sub(1)..=(x + 1).min(width - 1),
            y.saturating_sub(1)..=(y + 1).min(height - 1),
        );
        let count = (xs.clone().count() * ys.clone().count()) as f32;
        let all = ys.flat_map(|y| xs.clone().map(move |x| (x, y)));
        let sum = all.fold([0.0; 4], |sum: [f32; 4], (x, y)| {
            let one = of(x, y);
            [0, 1, 2, 3].map(|c| sum[c] + one[c])
        });
        sum.map(|s| s / count)
    };
    (0..width * height).map(mean).collect()
}

/// What weights are made of.
struct By<'a> {
    colors: &'a [[f32; 4]],
    variance: &'a [[f32; 4]],
    width: i32,
    height: i32,
}

impl By<'_> {
    /// Adds half of the filtered picture to the rows from `first` on.
    fn add_filtered(&self, of: &[[f32; 4]], first: i32, band: &mut [[f32; 4]]) {
        let rows = band.len() as i32 / self.width;
        let mut sums = vec![[0.0_f32; 4]; band.len()];
        let mut weights = vec![0.0_f32; band.len()];
        for dy in -WINDOW..=WINDOW {
            for dx in -WINDOW..=WINDOW {
                let distances = self.distances([dx, dy], first - PATCH, rows + 2 * PATCH);
                for y in 0..rows {
                    let other_y = first + y + dy;
                    if !(0..self.height).contains(&other_y) {
                        continue;
                    }
                    for x in (-dx).max(0)..self.width.min(self.width - dx) {
                        let weight = (-self.in_patch(&distances, x, y).max(0.0)).exp();
                        if weight < LEAST_WEIGHT {
                            continue;
                        }
                        let own = (y * self.width + x) as usize;
                        let other = of[(other_y * self.width + x + dx) as usize];
                        let sum = &mut sums[own];
                        *sum = [0, 1, 2, 3].map(|c| sum[c] + weight * other[c]);
                        weights[own] += weight;
                    }
                }
            }
        }
        for (i, pixel) in band.iter_mut().enumerate() {
            let at = (first * self.width) as usize + i;
            // Without noise there is nothing to take out, and a mean would round.
            let is_exact = self.variance[at] == [0.0; 4];
            for c in 0..4 {
                let filtered = if is_exact {
                    of[at][c]
                } else {
                    sums[i][c] / weights[i]
                };
                pixel[c] += 0.5 * filtered;
            }
        }
    }

    /// Of pixels to those so far away, in rows from `first` on, each the sum over a row of a patch; beyond the edges of the
    /// picture the edge counts.
    fn distances(&self, shift: [i32; 2], first: i32, rows: i32) -> Vec<f32> {
        let mut all = Vec::with_capacity((rows * self.width) as usize);
        let mut row = vec![0.0_f32; self.width as usize];
        for y in first..first + rows {
            for (x, distance) in (0..).zip(&mut row) {
                *distance = self.distance([x, y], shift);
            }
            for x in 0..self.width {
                let taps = (-PATCH..=PATCH).map(|k| row[(x + k).clamp(0, self.width - 1) as usize]);
                all.push(taps.sum());
            }
        }
        all
    }

    fn distance(&self, [x, y]: [i32; 2], [dx, dy]: [i32; 2]) -> f32 {
        let place = |x: i32, y: i32| {
            let [x, y] = [x.clamp(0, self.width - 1), y.clamp(0, self.height - 1)];
            (y * self.width + x) as usize
        };
        let (p, q) = (place(x, y), place(x + dx, y + dy));
        let (colors, variance) = (self.colors, self.variance);
        let of = |c: usize| {
            let [own, other] = [variance[p][c], variance[q][c]];
            let apart = (colors[p][c] - colors[q][c]).powi(2) - (own + own.min(other));
            apart / (LEAST + STRENGTH * STRENGTH * (own + other))
        };
        0.25 * (of(0) + of(1) + of(2) + of(3))
    }

    /// The mean over the patch around a pixel of the band.
    fn in_patch(&self, distances: &[f32], x: i32, y: i32) -> f32 {
        let side = 2 * PATCH + 1;
        let taps = (0..side).map(|k| distances[((y + k) * self.width + x) as usize]);
        taps.sum::<f32>() / (side * side) as f32
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

    #[test]
    fn noise_falls_and_edges_stay() {
        let halves = [1, 2].map(|seed| noisy(seed, 0.3));
        let [a, b] = [&halves[0][..], &halves[1]];
        let mean: Vec<[f32; 4]> = a
            .iter()
            .zip(b)
            .map(|(a, b)| [0, 1, 2, 3].map(|c| 0.5 * (a[c] + b[c])))
            .collect();
        let (before, after) = (error(&mean), error(&denoised([a, b], WIDTH)));
        assert!(after < 0.35 * before, "{before} {after}");
    }

    #[test]
    fn a_picture_without_noise_stays_as_it_is() {
        let picture = noisy(0, 0.0);
        assert_eq!(denoised([&picture, &picture], WIDTH), picture);
    }

    #[test]
    fn the_mean_of_an_even_picture_stays() {
        let even = |seed: u32| -> Vec<[f32; 4]> {
            let numbers = (0..4096).map(|i| random_numbers::<f32>([i, seed, 0, 0]));
            numbers.map(|n| n.map(|n| n + 1.0)).collect()
        };
        let halves = [1, 2].map(even);
        let found = denoised([&halves[0], &halves[1]], 64);
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
