//! What paths leave beside their picture, summed up over its blocks as its colours are.
//!
//! ```text
//! layer = sum over blocks of (paths of the block) (mean of the block) / all paths
//! ```
//!
//! Sums are f64, of both halves of the blocks, and of the images alone that somebody wants: layers, or guides of the filter that
//! takes noise out.

use super::Renderer;
use crate::gpu::Use;
use crate::offscreen::Error;
use crate::picture::{Layer, LayerKind};
use crate::technique::gather::PATH_LAYERS;
use crate::technique::pathtrace::{
    GUIDE_IMAGES, Guide, PATH_IMAGES, PathMeans, guide_of, images_of, numbers_of,
};

/// Of a pixel in a file: four numbers of each half.
const BYTES_OF_IMAGE: usize = 8 * 2 * 4;

/// Sums of the images that paths fill.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct PathImages {
    /// Of both halves, for each pixel; `None`: nobody wants it.
    images: [Option<[Vec<[f64; 4]>; 2]>; PATH_IMAGES],
}

impl PathImages {
    /// None yet, of what layers of these kinds are made of, and guides.
    pub fn of(kinds: &[LayerKind], has_guides: bool) -> Self {
        let guides = GUIDE_IMAGES.iter().filter(|_| has_guides);
        let wanted = kinds.iter().flat_map(|&kind| images_of(kind)).chain(guides);
        Self::of_mask(wanted.fold(0, |mask, image| mask | 1 << image)).expect("images that exist")
    }

    /// The same of a mask with a bit an image; `None`: there is no such image.
    pub fn of_mask(mask: u32) -> Option<Self> {
        let is_wanted = |image: usize| mask >> image & 1 == 1;
        (mask >> PATH_IMAGES == 0).then(|| Self {
            images: std::array::from_fn(|image| is_wanted(image).then(Default::default)),
        })
    }

    /// A bit for each image that is summed up.
    pub fn mask(&self) -> u32 {
        let bits = self.images.iter().enumerate();
        bits.fold(0, |mask, (image, sums)| {
            mask | u32::from(sums.is_some()) << image
        })
    }

    /// Whether all that `other` has is summed up here too.
    pub fn include(&self, other: &Self) -> bool {
        other.mask() & !self.mask() == 0
    }

    /// How many bytes a pixel has in a file.
    pub fn bytes_of_pixel(&self) -> usize {
        BYTES_OF_IMAGE * self.mask().count_ones() as usize
    }

    /// As they stand in a file: of each image all pixels of one half, then all of the other.
    pub fn numbers(&self) -> impl Iterator<Item = &f64> {
        self.images.iter().flatten().flatten().flatten().flatten()
    }

    /// The same back, of so many pixels.
    pub fn fill(&mut self, pixels: usize, mut next: impl FnMut() -> f64) {
        for half in self.images.iter_mut().flatten().flatten() {
            *half = (0..pixels)
                .map(|_| std::array::from_fn(|_| next()))
                .collect();
        }
    }

    /// One more block of one half: the means of so many paths, of each image that is wanted.
    fn add(
        &mut self,
        (half, paths): (usize, u32),
        mut read: impl FnMut(usize) -> Result<Vec<[f32; 4]>, Error>,
    ) -> Result<(), Error> {
        let n = f64::from(paths);
        for (image, sums) in self.images.iter_mut().enumerate() {
            let Some(halves) = sums else {
                continue;
            };
            let found = read(image)?;
            for half in &mut *halves {
                half.resize(found.len(), [0.0; 4]);
            }
            for (sum, found) in halves[half].iter_mut().zip(found) {
                *sum = std::array::from_fn(|c| sum[c] + n * f64::from(found[c]));
            }
        }
        Ok(())
    }

    fn pixels(&self) -> usize {
        let lengths = self.images.iter().flatten().map(|[even, _]| even.len());
        lengths.max().unwrap_or(0)
    }

    /// The means of a pixel over so many paths of these halves; 0 of what nobody wants.
    fn means(&self, pixel: usize, halves: &[usize], paths: u32) -> PathMeans {
        let count = f64::from(paths);
        self.images.each_ref().map(|image| {
            let Some(sums) = image else {
                return [0.0; 4];
            };
            let sum = |c: usize| halves.iter().map(|&half| sums[half][pixel][c]).sum::<f64>();
            std::array::from_fn(|c| (sum(c) / count) as f32)
        })
    }

    /// A layer of a kind that was wanted, of all paths.
    pub fn layer(&self, kind: LayerKind, paths: u32) -> Layer {
        let of_pixel = |pixel: usize| {
            let numbers = numbers_of(kind, &self.means(pixel, &[0, 1], paths)).into_iter();
            numbers.take(kind.numbers())
        };
        Layer {
            kind,
            values: (0..self.pixels()).flat_map(of_pixel).collect(),
        }
    }

    /// What guides the filter of a half, of its paths.
    pub fn guides(&self, half: usize, paths: u32) -> Vec<Guide> {
        let pixels = 0..self.pixels();
        let guide = |pixel| guide_of(&self.means(pixel, &[half], paths));
        pixels.map(guide).collect()
    }
}

impl Renderer<'_> {
    /// Adds what the last block of so many paths, one of this half, has left beside its picture.
    pub(super) fn add_path_images(
        &mut self,
        block: (usize, u32),
        images: &mut PathImages,
    ) -> Result<(), Error> {
        let targets = self.targets.as_ref().expect("prepared");
        let image = targets.canvas.image(PATH_LAYERS);
        let device = &mut self.device;
        images.add(block, |number| {
            Ok(targets.read_layer(device, image, number as u32, Use::FragmentSampled)?)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_count_by_their_paths_and_unwanted_images_are_not_read() {
        let mut images = PathImages::of(&[LayerKind::Depth, LayerKind::Bounces], false);
        for (block, met, depth, bounces) in [((0, 2), 0.5, 1.0, 3.0), ((1, 6), 0.25, 2.0, 1.0)] {
            let read = |image: usize| {
                Ok(vec![match image {
                    0 => [0.0, 0.0, 0.0, met],
                    1 => [0.0, 0.0, 0.0, depth],
                    2 => [0.0, 0.0, 0.0, bounces],
                    other => panic!("image {other} is not wanted"),
                }])
            };
            images.add(block, read).expect("read");
        }
        let value = |kind| images.layer(kind, 8).values;
        // (2 1 + 6 2) / (2 .5 + 6 .25) and (2 3 + 6 1) / 8.
        assert_eq!(value(LayerKind::Depth), [5.6]);
        assert_eq!(value(LayerKind::Bounces), [1.5]);
        // Of one half alone: 1 and 2.
        assert_eq!(images.guides(0, 2)[0][1][3], 1.0);
        assert_eq!(images.guides(1, 6)[0][1][3], 2.0);
    }

    #[test]
    fn a_mask_says_which_images_there_are() {
        let none = PathImages::of(&[LayerKind::Noise], false);
        let depth = PathImages::of(&[LayerKind::Depth], false);
        let guides = PathImages::of(&[], true);
        let all = PathImages::of(&LayerKind::ALL, true);
        assert_eq!(
            [&none, &depth, &guides, &all].map(PathImages::mask),
            [0, 3, 3, 31]
        );
        assert!(all.include(&depth) && depth.include(&none) && !none.include(&depth));
        assert_eq!(PathImages::of_mask(31), Some(all));
        assert_eq!(PathImages::of_mask(32), None);
    }
}
