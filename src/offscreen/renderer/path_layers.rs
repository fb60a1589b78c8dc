//! Layers of paths, summed up over the blocks of a picture as its colours are.
//!
//! ```text
//! layer = sum over blocks of (paths of the block) (mean of the block) / all paths
//! ```
//!
//! Sums are f64, of the images that the wanted layers are made of alone.

use super::Renderer;
use crate::gpu::Use;
use crate::offscreen::Error;
use crate::picture::{Layer, LayerKind};
use crate::technique::gather::PATH_LAYERS;
use crate::technique::pathtrace::{PATH_IMAGES, images_of, numbers_of};

/// Sums of the layers of a picture of paths.
#[derive(Debug, Default)]
pub(super) struct PathLayers {
    /// Of the images that are wanted, for each pixel.
    images: [Option<Vec<[f64; 4]>>; PATH_IMAGES],
    paths: u32,
}

impl PathLayers {
    /// Of what layers of these kinds are made of.
    pub fn of(kinds: &[LayerKind]) -> Self {
        let mut images = <[_; PATH_IMAGES]>::default();
        for &image in kinds.iter().flat_map(|&kind| images_of(kind)) {
            images[image] = Some(Vec::new());
        }
        Self { images, paths: 0 }
    }

    /// One more block: the means of so many paths, of each image that is wanted.
    fn add(
        &mut self,
        paths: u32,
        mut read: impl FnMut(usize) -> Result<Vec<[f32; 4]>, Error>,
    ) -> Result<(), Error> {
        let n = f64::from(paths);
        for (image, sums) in self.images.iter_mut().enumerate() {
            let Some(sums) = sums else {
                continue;
            };
            let found = read(image)?;
            sums.resize(found.len(), [0.0; 4]);
            for (sum, found) in sums.iter_mut().zip(found) {
                *sum = std::array::from_fn(|c| sum[c] + n * f64::from(found[c]));
            }
        }
        self.paths += paths;
        Ok(())
    }

    /// A layer of a kind that was wanted.
    pub fn layer(&self, kind: LayerKind) -> Layer {
        let paths = f64::from(self.paths);
        let lengths = self.images.iter().flatten().map(Vec::len);
        let pixels = lengths.max().unwrap_or(0);
        let mean = |sums: &Option<Vec<[f64; 4]>>, pixel: usize| match sums {
            Some(sums) => sums[pixel].map(|sum| (sum / paths) as f32),
            None => [0.0; 4],
        };
        let of_pixel = |pixel: usize| {
            let means = self.images.each_ref().map(|sums| mean(sums, pixel));
            let numbers = numbers_of(kind, &means).into_iter();
            numbers.take(kind.numbers())
        };
        Layer {
            kind,
            values: (0..pixels).flat_map(of_pixel).collect(),
        }
    }
}

impl Renderer<'_> {
    /// Adds what the last block of so many paths has left beside its picture.
    pub(super) fn add_path_layers(
        &mut self,
        paths: u32,
        layers: &mut PathLayers,
    ) -> Result<(), Error> {
        let targets = self.targets.as_ref().expect("prepared");
        let image = targets.canvas.image(PATH_LAYERS);
        let device = &mut self.device;
        layers.add(paths, |number| {
            Ok(targets.read_layer(device, image, number as u32, Use::FragmentSampled)?)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_count_by_their_paths_and_unwanted_images_are_not_read() {
        let mut layers = PathLayers::of(&[LayerKind::Depth, LayerKind::Bounces]);
        for (paths, met, depth, bounces) in [(2, 0.5, 1.0, 3.0), (6, 0.25, 2.0, 1.0)] {
            let read = |image: usize| {
                Ok(vec![match image {
                    0 => [0.0, 0.0, 0.0, met],
                    1 => [0.0, 0.0, 0.0, depth],
                    2 => [0.0, 0.0, 0.0, bounces],
                    other => panic!("image {other} is not wanted"),
                }])
            };
            layers.add(paths, read).expect("read");
        }
        let value = |kind| layers.layer(kind).values;
        // (2 1 + 6 2) / (2 .5 + 6 .25) and (2 3 + 6 1) / 8.
        assert_eq!(value(LayerKind::Depth), [5.6]);
        assert_eq!(value(LayerKind::Bounces), [1.5]);
    }
}
