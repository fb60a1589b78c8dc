//! What paths have brought so far: sums that another run can go on with.
//!
//! ```text
//! mean      = (sum of one half of the blocks + sum of the other) / N
//! deviation = S2 - S1^2 / N
//! ```
//!
//! Blocks have N paths a pixel together; S1 is the sum of n y and S2 that of n y^2 over blocks of n paths whose mean
//! luminance is y, which tell the noise (`technique/pathtrace/noise.rs`). Sums are f64, and those of a picture that is gone on with are those of one that never stopped.

use super::path_layers::PathImages;
use crate::offscreen::Error;
use crate::picture::{Layer, LayerKind};
use crate::technique::pathtrace::{Guide, PathBlocks, luminance};

/// Sums of the paths of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathSums {
    /// Two pictures whose paths know nothing of each other (`shaders/lib/sobol.wgsl`).
    halves: [Vec<[f64; 4]>; 2],
    paths_of_halves: [u32; 2],
    blocks: u32,
    /// Of the luminance of each block's pixels: S1 and S2.
    luminance: Vec<[f64; 2]>,
    /// What paths leave beside their colours.
    images: PathImages,
}

/// Of a pixel in a file: two colours with alpha and two numbers of luminance; images come behind.
const BYTES_OF_PIXEL: usize = 8 * (2 * 4 + 2);

impl PathSums {
    /// Paths of each pixel.
    pub fn paths(&self) -> u32 {
        self.paths_of_halves.iter().sum()
    }

    /// How many bytes of [`Self::to_bytes`] stand before the pixels.
    pub const HEAD_BYTES: usize = 4 * 4;

    /// How long [`Self::to_bytes`] are of a picture of so many pixels that begin with `head`; `None`: no sums do.
    pub fn byte_count(head: [u8; Self::HEAD_BYTES], pixels: u64) -> Option<u64> {
        let [.., mask] = counts_of(head);
        let images = PathImages::of_mask(mask)?;
        let bytes_of_pixel = BYTES_OF_PIXEL + images.bytes_of_pixel();
        Some(Self::HEAD_BYTES as u64 + pixels * bytes_of_pixel as u64)
    }

    /// As they stand in a file, little-endian: four u32, blocks, the paths of one half and of the other, and a bit for each image
    /// that is there beside the colours; then f64, for each pixel the sum of one half, for each that of the other, for each
    /// S1 and S2, and of each image the sums of both halves.
    pub fn to_bytes(&self) -> Vec<u8> {
        let [even, odd] = self.paths_of_halves;
        let mut bytes = Vec::new();
        for count in [self.blocks, even, odd, self.images.mask()] {
            bytes.extend_from_slice(&count.to_le_bytes());
        }
        let colors = self.halves.iter().flatten().flatten();
        let numbers = colors.chain(self.luminance.iter().flatten());
        for number in numbers.chain(self.images.numbers()) {
            bytes.extend_from_slice(&number.to_le_bytes());
        }
        bytes
    }

    /// What [`Self::to_bytes`] has written of a picture of so many pixels; `None` for other bytes.
    pub fn from_bytes(bytes: &[u8], pixels: usize) -> Option<Self> {
        let (&head, numbers) = bytes.split_first_chunk()?;
        let wanted = Self::byte_count(head, pixels as u64)?;
        let [blocks, even, odd, mask] = counts_of(head);
        let all = even.checked_add(odd)?;
        if bytes.len() as u64 != wanted || all == 0 {
            return None;
        }
        let mut numbers = numbers
            .chunks_exact(8)
            .map(|c| f64::from_le_bytes(c.try_into().expect("eight bytes")));
        let mut next = || numbers.next().expect("as many as were counted");
        let halves = [(); 2].map(|()| {
            let pixel = |_| std::array::from_fn(|_| next());
            (0..pixels).map(pixel).collect()
        });
        let luminance = (0..pixels)
            .map(|_| std::array::from_fn(|_| next()))
            .collect();
        let mut images = PathImages::of_mask(mask)?;
        images.fill(pixels, next);
        Some(Self {
            halves,
            paths_of_halves: [even, odd],
            blocks,
            luminance,
            images,
        })
    }

    /// Whether a layer of paths can be made of them.
    pub fn have(&self, kind: LayerKind) -> bool {
        self.images.include(&PathImages::of(&[kind], false))
    }

    /// Whether there are images beside colours.
    pub(super) fn have_images(&self) -> bool {
        self.images.mask() != 0
    }

    /// From here on what these layers are made of is summed up, and guides.
    ///
    /// # Errors
    /// [`Error::NoLayersOfBegun`] where paths are there already, without it.
    pub(super) fn want(&mut self, kinds: &[LayerKind], has_guides: bool) -> Result<(), Error> {
        let wanted = PathImages::of(kinds, has_guides);
        if self.paths() == 0 {
            self.images = wanted;
        } else if !self.images.include(&wanted) {
            return Err(Error::NoLayersOfBegun);
        }
        Ok(())
    }

    /// What paths leave beside their colours, which each block is added to.
    pub(super) fn images(&mut self) -> &mut PathImages {
        &mut self.images
    }

    /// One more block of one half: the means of so many paths.
    pub(super) fn add(&mut self, half: usize, found: &[[f32; 4]], paths: u32) {
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

    /// Two pictures of different paths; `None` where one has none.
    pub(super) fn halves(&self) -> Option<[Vec<[f32; 4]>; 2]> {
        self.paths_of_halves.iter().all(|&n| n > 0).then(|| {
            [0, 1].map(|half| {
                let count = f64::from(self.paths_of_halves[half]);
                let mean = |sum: &[f64; 4]| sum.map(|s| (s / count) as f32);
                self.halves[half].iter().map(mean).collect()
            })
        })
    }

    /// What guides the filter of each half.
    pub(super) fn guides(&self) -> [Vec<Guide>; 2] {
        [0, 1].map(|half| self.images.guides(half, self.paths_of_halves[half]))
    }

    /// The standard error of luminance, as a part of what the picture shows; `None`: one block does not tell.
    pub(super) fn noise(&self) -> Option<f64> {
        let paths = f64::from(self.paths());
        let [mut deviations, mut squares] = [0.0; 2];
        for of_pixel in &self.luminance {
            deviations += self.deviation(of_pixel).max(0.0);
            squares += (of_pixel[0] / paths).powi(2);
        }
        self.path_blocks().noise(deviations, squares)
    }

    fn path_blocks(&self) -> PathBlocks {
        PathBlocks {
            paths: self.paths(),
            blocks: self.blocks,
        }
    }

    /// Of the luminance of a pixel's blocks.
    fn deviation(&self, &[first, second]: &[f64; 2]) -> f64 {
        second - first * first / f64::from(self.paths())
    }

    /// A layer of a kind that [`Self::want`] was told of.
    pub(super) fn layer(&self, kind: LayerKind) -> Layer {
        let values = match kind {
            LayerKind::Noise => {
                let variance = |sums| self.path_blocks().variance(self.deviation(sums));
                let error = |sums| variance(sums).sqrt() as f32;
                self.luminance.iter().map(error).collect()
            }
            // The part of paths that have met nothing.
            LayerKind::Transmittance => self.mean().iter().map(|[.., alpha]| 1.0 - alpha).collect(),
            _ => return self.images.layer(kind, self.paths()),
        };
        Layer { kind, values }
    }
}

/// Blocks, paths of both halves, and the mask of images.
fn counts_of(head: [u8; PathSums::HEAD_BYTES]) -> [u32; 4] {
    std::array::from_fn(|i| {
        let bytes = head[4 * i..][..4].try_into();
        u32::from_le_bytes(bytes.expect("four bytes"))
    })
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
            sums.add((sums.blocks % 2) as usize, &found, count);
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
        let mut sums = blocks_of([2, 2, 8].into_iter());
        let head = |bytes: &[u8]| *bytes.first_chunk().expect("a head");
        for kinds in [&[][..], &[LayerKind::Direct]] {
            let mut number = 0.0;
            sums.images = PathImages::of(kinds, !kinds.is_empty());
            sums.images.fill(4096, || {
                number += 1.0;
                number
            });
            let bytes = sums.to_bytes();
            let wanted = PathSums::byte_count(head(&bytes), 4096);
            assert_eq!(Some(bytes.len() as u64), wanted);
            assert_eq!(PathSums::from_bytes(&bytes, 4096), Some(sums.clone()));
            assert_eq!(PathSums::from_bytes(&bytes, 4095), None);
            assert_eq!(PathSums::from_bytes(&bytes[1..], 4096), None);
        }
        assert!(sums.have(LayerKind::Noise) && sums.have(LayerKind::Depth));
        assert!(sums.have(LayerKind::Direct) && !sums.have(LayerKind::Indirect));
        assert!(sums.want(&[LayerKind::Direct], true).is_ok());
        assert!(sums.want(&[LayerKind::Indirect], true).is_err());
        assert_eq!(PathSums::from_bytes(&[0; 8], 0), None);
        let of_none = [0; PathSums::HEAD_BYTES + BYTES_OF_PIXEL];
        assert_eq!(PathSums::from_bytes(&of_none, 1), None);
        assert_eq!(PathSums::from_bytes(&[255; PathSums::HEAD_BYTES], 0), None);
    }
}
