//! What paths have brought so far: sums that another run can go on with.
//!
//! ```text
//! mean     = (sum of even blocks + sum of odd blocks) / N
//! noise    = sqrt(sum over pixels of the variance of their means) / sqrt(sum of their squares)      of luminance
//! variance = (S2 - S1^2 / N) / (N (B - 1))
//! ```
//!
//! B blocks have N paths a pixel together; S1 is the sum of n y and S2 that of n y^2 over blocks of n paths whose mean
//! luminance is y. Sums are f64, and those of a picture that is gone on with are those of one that never stopped.

use crate::picture::{Layer, LayerKind};

/// Sums of the paths of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathSums {
    /// Of even and of odd blocks, two pictures of different paths.
    halves: [Vec<[f64; 4]>; 2],
    paths_of_halves: [u32; 2],
    blocks: u32,
    /// Of the luminance of each block's pixels: S1 and S2.
    luminance: Vec<[f64; 2]>,
}

/// Of a pixel in a file: two colours with alpha and two numbers of luminance.
const BYTES_OF_PIXEL: usize = 8 * (2 * 4 + 2);
/// Before the pixels: blocks, and paths of even and of odd ones.
const BYTES_OF_COUNTS: usize = 4 * 3;

impl PathSums {
    /// Paths of each pixel.
    pub fn paths(&self) -> u32 {
        self.paths_of_halves.iter().sum()
    }

    /// How long [`Self::to_bytes`] of a picture of so many pixels are.
    pub fn byte_count(pixels: u64) -> u64 {
        BYTES_OF_COUNTS as u64 + pixels * BYTES_OF_PIXEL as u64
    }

    /// As they stand in a file, little-endian: three u32, blocks and the paths of even and of odd ones; then f64, for each
    /// pixel the sum of even blocks, for each that of odd blocks, for each S1 and S2.
    pub fn to_bytes(&self) -> Vec<u8> {
        let [even, odd] = self.paths_of_halves;
        let count = Self::byte_count(self.luminance.len() as u64);
        let mut bytes = Vec::with_capacity(count as usize);
        for count in [self.blocks, even, odd] {
            bytes.extend_from_slice(&count.to_le_bytes());
        }
        let colors = self.halves.iter().flatten().flatten();
        for number in colors.chain(self.luminance.iter().flatten()) {
            bytes.extend_from_slice(&number.to_le_bytes());
        }
        bytes
    }

    /// What [`Self::to_bytes`] has written of a picture of so many pixels; `None` for other bytes.
    pub fn from_bytes(bytes: &[u8], pixels: usize) -> Option<Self> {
        let is_whole = bytes.len() as u64 == Self::byte_count(pixels as u64);
        let (counts, numbers) = bytes.split_at_checked(BYTES_OF_COUNTS)?;
        let mut counts = counts
            .chunks_exact(4)
            .map(|c| u32::from_le_bytes(c.try_into().expect("four bytes")));
        let [blocks, even, odd] = std::array::from_fn(|_| counts.next().unwrap_or(0));
        even.checked_add(odd).filter(|&all| is_whole && all > 0)?;
        let mut numbers = numbers
            .chunks_exact(8)
            .map(|c| f64::from_le_bytes(c.try_into().expect("eight bytes")));
        let mut next = || numbers.next().expect("as many as were counted");
        let halves = [(); 2].map(|()| {
            let pixel = |_| std::array::from_fn(|_| next());
            (0..pixels).map(pixel).collect()
        });
        Some(Self {
            halves,
            paths_of_halves: [even, odd],
            blocks,
            luminance: (0..pixels)
                .map(|_| std::array::from_fn(|_| next()))
                .collect(),
        })
    }

    /// One more block: the means of so many paths.
    pub(super) fn add(&mut self, found: &[[f32; 4]], paths: u32) {
        let half = (self.blocks % 2) as usize;
        for half in &mut self.halves {
            half.resize(found.len(), [0.0; 4]);
        }
        self.luminance.resize(found.len(), [0.0; 2]);
        let n = f64::from(paths);
        for (sum, found) in self.halves[half].iter_mut().zip(found) {
            *sum = std::array::from_fn(|c| sum[c] + n * f64::from(found[c]));
        }
        for (sum, found) in self.luminance.iter_mut().zip(found) {
            let y = luminance(found.map(f64::from));
            *sum = [sum[0] + n * y, sum[1] + n * y * y];
        }
        self.paths_of_halves[half] += paths;
        self.blocks += 1;
    }

    /// Of all paths.
    pub(super) fn mean(&self) -> Vec<[f32; 4]> {
        let count = f64::from(self.paths());
        let [even, odd] = &self.halves;
        let mean = |(a, b): (&[f64; 4], &[f64; 4])| {
            std::array::from_fn(|c| ((a[c] + b[c]) / count) as f32)
        };
        even.iter().zip(odd).map(mean).collect()
    }

    /// Two pictures of different paths; `None` where one block is all.
    pub(super) fn halves(&self) -> Option<[Vec<[f32; 4]>; 2]> {
        (self.blocks > 1).then(|| {
            [0, 1].map(|half| {
                let count = f64::from(self.paths_of_halves[half]);
                let mean = |sum: &[f64; 4]| sum.map(|s| (s / count) as f32);
                self.halves[half].iter().map(mean).collect()
            })
        })
    }

    /// The standard error of luminance, as a part of what the picture shows; `None`: one block does not tell.
    pub(super) fn noise(&self) -> Option<f64> {
        if self.blocks < 2 {
            return None;
        }
        let paths = f64::from(self.paths());
        let [mut variance, mut squares] = [0.0; 2];
        for of_pixel in &self.luminance {
            variance += self.variance(of_pixel);
            squares += (of_pixel[0] / paths).powi(2);
        }
        (squares > 0.0).then(|| (variance / squares).sqrt())
    }

    /// Of the mean luminance of a pixel; NaN where one block is all.
    fn variance(&self, &[first, second]: &[f64; 2]) -> f64 {
        let (paths, blocks) = (f64::from(self.paths()), f64::from(self.blocks));
        let variance = (second - first * first / paths) / (paths * (blocks - 1.0));
        match self.blocks > 1 {
            true => variance.max(0.0),
            false => f64::NAN,
        }
    }

    /// The layers that follow from the sums themselves.
    pub(super) fn layer(&self, kind: LayerKind) -> Option<Layer> {
        let values = match kind {
            LayerKind::Noise => {
                let deviation = |sums| self.variance(sums).sqrt() as f32;
                self.luminance.iter().map(deviation).collect()
            }
            // The part of paths that have met nothing.
            LayerKind::Transmittance => self.mean().iter().map(|[.., alpha]| 1.0 - alpha).collect(),
            _ => return None,
        };
        Some(Layer { kind, values })
    }
}

/// Of linear light (ITU-R BT.709).
fn luminance([r, g, b, _]: [f64; 4]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Blocks of so many paths, whose pixels are 1 or 3 by chance for each path.
    fn blocks_of(paths: impl Iterator<Item = u32>) -> PathSums {
        let mut sums = PathSums::default();
        let mut first = 0;
        for count in paths {
            let of_path = |i: u32, path: u32| {
                // A mixer of whole numbers (Wellons' lowbias32, 2018).
                let mut x = i + 4096 * path;
                x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
                x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
                if (x >> 16) & 1 == 0 { 1.0 } else { 3.0 }
            };
            let pixel = |i: u32| {
                let paths = first..first + count;
                [paths.map(|path| of_path(i, path)).sum::<f32>() / count as f32; 4]
            };
            let found: Vec<_> = (0..4096).map(pixel).collect();
            sums.add(&found, count);
            first += count;
        }
        sums
    }

    /// Of a path 1, of a mean of n of them 1 / sqrt(n), as a part of 2: whichever blocks they come in.
    #[test]
    fn noise_is_the_error_of_the_mean() {
        let alike = blocks_of([4; 64].into_iter());
        let unlike = blocks_of([2; 4].into_iter().chain([8; 31]));
        for sums in [alike, unlike] {
            assert_eq!(sums.paths(), 256);
            let noise = sums.noise().expect("many blocks tell");
            // The variance of 4096 estimates of a variance by 34 degrees of freedom: 0.4 % of it.
            assert!(
                (noise - 0.5 / 16.0).abs() < 4.0 * 0.002 * 0.5 / 16.0,
                "{noise}"
            );
            let [a, b] = sums.halves().expect("several blocks");
            assert!(a != b);
        }
    }

    #[test]
    fn sums_come_back_from_bytes_of_the_right_length() {
        let sums = blocks_of([2, 2, 8].into_iter());
        let bytes = sums.to_bytes();
        assert_eq!(bytes.len() as u64, PathSums::byte_count(4096));
        assert_eq!(PathSums::from_bytes(&bytes, 4096), Some(sums));
        assert_eq!(PathSums::from_bytes(&bytes, 4095), None);
        assert_eq!(PathSums::from_bytes(&bytes[1..], 4096), None);
        assert_eq!(PathSums::from_bytes(&[0; 8], 0), None);
        let of_none = [0; BYTES_OF_COUNTS + BYTES_OF_PIXEL];
        assert_eq!(PathSums::from_bytes(&of_none, 1), None);
        assert_eq!(PathSums::from_bytes(&[255; BYTES_OF_COUNTS], 0), None);
    }
}
