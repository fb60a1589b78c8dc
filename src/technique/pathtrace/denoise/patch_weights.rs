//! Which pixels are alike: weights of non-local means.
//!
//! ```text
//! d^2(p, q) = mean over 5 x 5 and groups of sum ((b_p - b_q)^2 - (v_p + min(v_p, v_q))) / (least + k^2 sum (v_p + v_q))
//! w(p, q)   = exp(-max(0, d^2))                                 sums: over the numbers of a group
//! ```

use super::planes::Plane;
use super::tiles::Tile;
use super::{PATCH, SIDE, TAPS, WINDOW, rows};
use std::ops::Range;

/// Pixels farther apart have no weight: it would be a thousandth.
const MOST_APART: f32 = 6.9;

/// How numbers of pixels are compared.
pub(super) struct Comparison {
    /// Which numbers.
    pub numbers: Range<usize>,
    /// Squares of so many are added, a group, before they are compared with their variances.
    pub together: usize,
    /// k: how far pixels may differ, in standard deviations of their difference.
    pub strength: f32,
    /// Squares of differences that are none.
    pub least: f32,
}

/// What weights are made of: numbers and their variances.
pub(super) struct PatchWeights<'p> {
    pub values: &'p [Plane],
    pub variances: &'p [Plane],
    pub comparison: &'p Comparison,
    pub size: [usize; 2],
}

/// Pixels of a row of a tile, and those that are a shift away.
pub(super) struct Shifted<'w> {
    /// The row, from the first of the tile.
    pub row: usize,
    /// How far the others are, from [`WINDOW`] before: across and down.
    pub shift: [usize; 2],
    /// Of each pixel of the row that of the other, 0 where that is outside.
    pub weights: &'w [f32],
}

impl PatchWeights<'_> {
    /// Tells `each` the weights of all pixels of a tile with all of their windows; rows without any are left out.
    pub fn in_windows(&self, tile: &Tile, mut each: impl FnMut(&Shifted)) {
        let [width, height] = self.size;
        let count = tile.columns.len();
        let mut distances = vec![0.0_f32; (tile.rows.len() + 2 * PATCH) * count];
        let mut weights = vec![0.0_f32; count];
        let mut apart = Apart::new(count + 2 * PATCH);
        for shift in 0..SIDE * SIDE {
            let [across, down] = [shift % SIDE, shift / SIDE];
            for (y, sums) in distances.chunks_mut(count).enumerate() {
                let place = [tile.columns.start, tile.rows.start + y];
                self.compare(place, [across, down], &mut apart);
                apart.sum_over_patches(sums);
            }
            // Others of columns from the one to the other are in the picture.
            let first_other = tile.columns.start + across;
            let inside = WINDOW.saturating_sub(first_other)
                ..(width + WINDOW).saturating_sub(first_other).min(count);
            for row in 0..tile.rows.len() {
                let other_row = tile.rows.start + row + down;
                if inside.is_empty() || other_row < WINDOW || other_row >= height + WINDOW {
                    continue;
                }
                weights.fill(0.0);
                for patch in distances[row * count..].chunks(count).take(TAPS) {
                    rows::add(&mut weights, |x| patch[x]);
                }
                let mut is_any = false;
                for (x, weight) in weights.iter_mut().enumerate() {
                    let apart = weight.max(0.0) / (TAPS * TAPS) as f32;
                    *weight = match inside.contains(&x) && apart <= MOST_APART {
                        true => (-apart).exp(),
                        false => 0.0,
                    };
                    is_any |= *weight > 0.0;
                }
                if is_any {
                    each(&Shifted {
                        row,
                        shift: [across, down],
                        weights: &weights,
                    });
                }
            }
        }
    }

    /// How far pixels from this one on, counted from [`PATCH`] rows and columns before the picture, are from those a shift away.
    fn compare(&self, [x, y]: [usize; 2], [across, down]: [usize; 2], apart: &mut Apart) {
        let count = apart.squares.len();
        apart.squares.fill(0.0);
        let Comparison {
            numbers, together, ..
        } = self.comparison;
        for first in numbers.clone().step_by(*together) {
            apart.clear();
            for n in first..first + together {
                let [values, variances] = [&self.values[n], &self.variances[n]].map(|plane| {
                    let own = plane.row(y + WINDOW, x + WINDOW, count);
                    [own, plane.row(y + down, x + across, count)]
                });
                apart.add(values, variances);
            }
            apart.divide(self.comparison);
        }
    }
}

/// Differences of the pixels of a row.
struct Apart {
    /// Squares beyond what variances explain, and the variances.
    above: Vec<f32>,
    below: Vec<f32>,
    /// The mean over groups.
    squares: Vec<f32>,
}

impl Apart {
    fn new(count: usize) -> Self {
        let none = vec![0.0; count];
        Self {
            above: none.clone(),
            below: none.clone(),
            squares: none,
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
        rows::add(above, |i| {
            (p[i] - q[i]) * (p[i] - q[i]) - (v[i] + v[i].min(w[i]))
        });
        rows::add(below, |i| v[i] + w[i]);
    }

    fn divide(&mut self, by: &Comparison) {
        let weight = by.together as f32 / by.numbers.len() as f32;
        let strength = by.strength * by.strength;
        let count = self.squares.len();
        let (above, below) = (&self.above[..count], &self.below[..count]);
        rows::add(&mut self.squares, |i| {
            weight * (above[i] / (by.least + strength * below[i]))
        });
    }

    /// The sums over rows of patches, of each pixel of the picture.
    fn sum_over_patches(&self, sums: &mut [f32]) {
        sums.fill(0.0);
        for tap in 0..TAPS {
            let squares = &self.squares[tap..][..sums.len()];
            rows::add(sums, |x| squares[x]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{planes::planes, tiles::in_tiles};
    use super::*;

    /// Where all pixels are alike, each of a window counts as one, and none outside.
    #[test]
    fn windows_end_at_the_picture() {
        let size = [70, 18];
        let even = planes(&vec![[0.5_f32]; size[0] * size[1]], size);
        let weights = PatchWeights {
            values: &even,
            variances: &planes(&vec![[0.0_f32]; size[0] * size[1]], size),
            comparison: &Comparison {
                numbers: 0..1,
                together: 1,
                strength: 1.0,
                least: 1e-3,
            },
            size,
        };
        let sums = in_tiles(size, |tile| {
            let mut sums = vec![0.0_f32; tile.len()];
            weights.in_windows(tile, |shifted| {
                let row = &mut sums[shifted.row * tile.columns.len()..];
                for (sum, weight) in row.iter_mut().zip(shifted.weights) {
                    *sum += weight;
                }
            });
            sums
        });
        let inside = |i: usize, side: usize| 1 + i.min(WINDOW) + (side - 1 - i).min(WINDOW);
        for (at, sum) in sums.into_iter().enumerate() {
            let wanted = inside(at % size[0], size[0]) * inside(at / size[0], size[1]);
            assert_eq!(sum, wanted as f32, "pixel {at}");
        }
    }

    #[test]
    fn what_noise_explains_is_not_apart() {
        let numbers = [[0.5_f32; 1], [0.7; 1]];
        for together in [1, 3] {
            let comparison = Comparison {
                numbers: 0..together,
                together,
                strength: 1.0,
                least: 1e-3,
            };
            // Each number is apart by its standard deviation, and by five of them.
            let [even, clear] = [0.02_f32, 0.0008].map(|variance| {
                let mut apart = Apart::new(1);
                for _ in 0..together {
                    apart.add([&numbers[0], &numbers[1]], [&[variance]; 2]);
                }
                apart.divide(&comparison);
                apart.squares[0]
            });
            assert!(even <= 0.0 && clear > 5.0, "{even} {clear}");
        }
    }
}
