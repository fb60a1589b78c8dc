//! The 256 colours that a film is best shown with.
//!
//! Where a film has no more of them, they are its own. Else boxes of colours are split until there are 256, each
//! time the box with the largest sum of squared distances from its mean, at its mean along the axis where it
//! spreads most (Wan, Wong, Prusinkiewicz, "An algorithm for multidimensional data clustering", ACM TOMS 14(2),
//! 1988). Then every colour goes to its nearest mean and means are taken again, some times (Lloyd 1982).
//!
//! Pixels are dithered with a fixed pattern (Bayer 1973): shades between two colours of the palette are seen,
//! and what does not move does not flicker.

use crate::cli::Error;
use std::collections::{HashMap, HashSet};

const MOST_COLORS: usize = 256;
/// Colours are counted by so many high bits of each channel.
const BITS: u32 = 6;
const LLOYD_ROUNDS: usize = 3;

/// The colours, and whether they are all there are.
#[derive(Debug)]
pub struct Palette {
    /// At least one, at most 256.
    pub colors: Vec<[u8; 3]>,
    /// Where each colour of the film has its index.
    exact: Option<HashMap<[u8; 3], u8>>,
    /// How far dithering moves a channel.
    amplitude: f32,
}

/// Colours that share their high bits: how many pixels, and sums of their channels.
#[derive(Clone, Copy, Debug, Default)]
struct Bin {
    count: f64,
    sum: [f64; 3],
}

impl Palette {
    /// Of frames with red, green, blue and alpha a pixel.
    pub fn of(frames: impl Iterator<Item = Result<Vec<u8>, Error>>) -> Result<Self, Error> {
        let mut exact = HashSet::new();
        let mut bins = vec![Bin::default(); 1 << (3 * BITS)];
        for codes in frames {
            for &[r, g, b, _] in codes?.as_chunks::<4>().0 {
                if exact.len() <= MOST_COLORS {
                    exact.insert([r, g, b]);
                }
                let place = [r, g, b].map(|code| usize::from(code >> (8 - BITS)));
                let bin = &mut bins[(place[0] << (2 * BITS)) | (place[1] << BITS) | place[2]];
                bin.count += 1.0;
                bin.sum[0] += f64::from(r);
                bin.sum[1] += f64::from(g);
                bin.sum[2] += f64::from(b);
            }
        }
        if exact.len() <= MOST_COLORS {
            let mut colors: Vec<_> = exact.into_iter().collect();
            colors.sort_unstable();
            let indices = colors
                .iter()
                .zip(0..=u8::MAX)
                .map(|(&color, index)| (color, index));
            return Ok(Self {
                exact: Some(indices.collect()),
                amplitude: 0.0,
                colors,
            });
        }
        bins.retain(|bin| bin.count > 0.0);
        let mut means = split(&bins);
        for _ in 0..LLOYD_ROUNDS {
            means = moved(&bins, &means);
        }
        let mut colors: Vec<_> = means
            .iter()
            .map(|mean| mean.map(|x| x.round() as u8))
            .collect();
        colors.sort_unstable();
        colors.dedup();
        Ok(Self {
            amplitude: spacing(&bins, &means),
            colors,
            exact: None,
        })
    }

    /// The index of each pixel of a frame that is `width` wide.
    pub fn indices(&self, codes: &[u8], width: usize) -> Vec<u8> {
        let pixels = codes
            .as_chunks::<4>()
            .0
            .iter()
            .map(|&[r, g, b, _]| [r, g, b]);
        if let Some(exact) = &self.exact {
            return pixels
                .map(|pixel| exact.get(&pixel).copied().unwrap_or(0))
                .collect();
        }
        let mut known = HashMap::new();
        let dithered = pixels.enumerate().map(|(i, pixel)| {
            let shift = self.amplitude * bayer(i % width, i / width);
            let shifted =
                pixel.map(|code| (f32::from(code) + shift).round().clamp(0.0, 255.0) as u8);
            *known
                .entry(shifted)
                .or_insert_with(|| self.nearest(shifted))
        });
        dithered.collect()
    }

    fn nearest(&self, color: [u8; 3]) -> u8 {
        let apart = |other: &[u8; 3]| -> u32 {
            (0..3)
                .map(|c| u32::from(color[c].abs_diff(other[c])).pow(2))
                .sum()
        };
        let nearest = self
            .colors
            .iter()
            .enumerate()
            .min_by_key(|(_, other)| apart(other));
        nearest.map_or(0, |(index, _)| index as u8)
    }
}

/// -0.5 to 0.5: the 8 x 8 pattern, `bit k of (x ^ y), bit k of y` from the lowest `k` up being the highest bits.
fn bayer(x: usize, y: usize) -> f32 {
    let level = (0..3).fold(0, |level, k| {
        (level << 2) | ((((x ^ y) >> k) & 1) << 1) | ((y >> k) & 1)
    });
    (level as f32 + 0.5) / 64.0 - 0.5
}

/// Means of boxes of bins.
fn split(bins: &[Bin]) -> Vec<[f64; 3]> {
    let mut boxes = vec![Cloud::of(bins.to_vec())];
    while boxes.len() < MOST_COLORS {
        let widest =
            (0..boxes.len()).max_by(|&a, &b| boxes[a].spread().total_cmp(&boxes[b].spread()));
        let Some(widest) = widest.filter(|&i| boxes[i].bins.len() > 1) else {
            break;
        };
        let Cloud { bins, mean, errors } = boxes.swap_remove(widest);
        let axis = (0..3)
            .max_by(|&a, &b| errors[a].total_cmp(&errors[b]))
            .unwrap_or(0);
        let (low, high) = bins
            .into_iter()
            .partition::<Vec<_>, _>(|bin| bin.mean()[axis] <= mean[axis]);
        // Bins whose means are all but equal cannot be parted.
        if low.is_empty() || high.is_empty() {
            let rest = [low, high].concat();
            boxes.push(Cloud {
                errors: [0.0; 3],
                ..Cloud::of(rest)
            });
            if boxes.iter().all(|cloud| cloud.spread() == 0.0) {
                break;
            }
            continue;
        }
        boxes.extend([Cloud::of(low), Cloud::of(high)]);
    }
    boxes.iter().map(|cloud| cloud.mean).collect()
}

impl Bin {
    fn mean(&self) -> [f64; 3] {
        self.sum.map(|sum| sum / self.count)
    }
}

/// Some bins, their mean, and the sums of squared distances from it along each axis.
struct Cloud {
    bins: Vec<Bin>,
    mean: [f64; 3],
    errors: [f64; 3],
}

impl Cloud {
    fn of(bins: Vec<Bin>) -> Self {
        let count: f64 = bins.iter().map(|bin| bin.count).sum();
        let mean = std::array::from_fn(|c| bins.iter().map(|bin| bin.sum[c]).sum::<f64>() / count);
        let error = |c: usize| {
            let of_bin = |bin: &Bin| bin.count * (bin.mean()[c] - mean[c]).powi(2);
            bins.iter().map(of_bin).sum()
        };
        let errors = [error(0), error(1), error(2)];
        Self { bins, mean, errors }
    }

    fn spread(&self) -> f64 {
        if self.bins.len() > 1 {
            self.errors.iter().sum()
        } else {
            0.0
        }
    }
}

fn squared_distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|c| (a[c] - b[c]).powi(2)).sum()
}

fn nearest_mean(means: &[[f64; 3]], color: [f64; 3]) -> usize {
    let apart = |i: &usize| squared_distance(means[*i], color);
    (0..means.len())
        .min_by(|a, b| apart(a).total_cmp(&apart(b)))
        .unwrap_or(0)
}

/// The means of what is nearest to each of `means`.
fn moved(bins: &[Bin], means: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut sums = vec![Bin::default(); means.len()];
    for bin in bins {
        let sum = &mut sums[nearest_mean(means, bin.mean())];
        sum.count += bin.count;
        sum.sum = std::array::from_fn(|c| sum.sum[c] + bin.sum[c]);
    }
    let pairs = sums.iter().zip(means);
    pairs
        .map(|(sum, &mean)| if sum.count > 0.0 { sum.mean() } else { mean })
        .collect()
}

/// The usual distance along one channel between two neighbours of the palette: twice that to the nearest mean.
fn spacing(bins: &[Bin], means: &[[f64; 3]]) -> f32 {
    let off = |bin: &Bin| {
        let color = bin.mean();
        squared_distance(means[nearest_mean(means, color)], color)
    };
    let count: f64 = bins.len() as f64;
    let mean: f64 = bins.iter().map(off).sum::<f64>() / count;
    (2.0 * (mean / 3.0).sqrt()) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(colors: impl IntoIterator<Item = [u8; 3]>) -> Vec<u8> {
        colors
            .into_iter()
            .flat_map(|[r, g, b]| [r, g, b, 255])
            .collect()
    }

    #[test]
    fn a_film_of_few_colours_keeps_each_of_them() {
        let frames = [
            frame((0..200).map(|i| [i, 0, 255 - i])),
            frame((0..56).map(|i| [i, i, i])),
        ];
        let palette = Palette::of(frames.iter().cloned().map(Ok)).expect("a palette");
        assert_eq!(palette.colors.len(), 256);
        for frame in &frames {
            let back = palette
                .indices(frame, 8)
                .into_iter()
                .map(|i| palette.colors[usize::from(i)]);
            assert_eq!(super::tests::frame(back), *frame);
        }
    }

    #[test]
    fn a_film_of_many_colours_is_near_everywhere_and_right_on_the_whole() {
        // A plane of colours: 256 of them in it are 16 apart along each of two axes.
        let colors = (0..128 * 128).map(|i| [2 * (i % 128) as u8, 2 * (i / 128) as u8, 99]);
        let codes = frame(colors);
        let palette = Palette::of([Ok(codes.clone())].into_iter()).expect("a palette");
        assert!(palette.colors.len() > 200, "{}", palette.colors.len());
        let (mut worst, mut sums) = (0, [0_i64; 3]);
        for (index, code) in palette
            .indices(&codes, 128)
            .into_iter()
            .zip(codes.as_chunks::<4>().0)
        {
            let color = palette.colors[usize::from(index)];
            for c in 0..3 {
                worst = worst.max(color[c].abs_diff(code[c]));
                sums[c] += i64::from(color[c]) - i64::from(code[c]);
            }
        }
        // A cell of 16 by 16, its neighbour by dithering, and cells are not all squares.
        assert!(worst <= 32, "{worst}");
        let count = 128 * 128;
        assert!(
            sums.iter().all(|sum| sum.abs() < count),
            "{sums:?} of {count} pixels"
        );
    }

    #[test]
    fn the_pattern_holds_each_level_once() {
        let mut levels: Vec<_> = (0..64).map(|i| bayer(i % 8, i / 8)).collect();
        levels.sort_by(f32::total_cmp);
        let wanted: Vec<_> = (0..64).map(|i| (i as f32 + 0.5) / 64.0 - 0.5).collect();
        assert_eq!(levels, wanted);
        assert_eq!(bayer(0, 0).min(bayer(1, 0)), bayer(0, 0));
    }
}
