//! MIP and its relatives: one ray a pixel in a compute pass, one number a ray.

pub mod exact;
pub mod reference;

use super::inputs::mode_word;
use super::{Inputs, Mode, Words};
use crate::gpu::{Bindings, ComputePipeline, Error, Gpu, Image, Resource, Tile};
use crate::shaders::shader;
use ash::vk;
use std::sync::Arc;

/// The compute pass of one mode.
#[derive(Debug)]
pub struct Projection {
    gpu: Arc<Gpu>,
    pipeline: ComputePipeline,
}

impl Projection {
    /// Compiles the variant of this mode and these words.
    ///
    /// # Errors
    /// Where the device refuses.
    pub fn new(gpu: &Arc<Gpu>, mode: Mode, words: &Words) -> Result<Self, Error> {
        let Words {
            filter,
            holes,
            lattice,
            ..
        } = words;
        let name = format!("projection.{}.{lattice}.{filter}.{holes}", mode_word(mode));
        Self::of_shader(gpu, &name)
    }

    /// The same for the exact extreme of the trilinear field, of [`Mode::Mip`] or [`Mode::Minip`].
    ///
    /// # Errors
    /// Where the device refuses.
    pub fn exact(gpu: &Arc<Gpu>, mode: Mode, words: &Words) -> Result<Self, Error> {
        let name = format!("projection_cells.{}.{}", mode_word(mode), words.holes);
        Self::of_shader(gpu, &name)
    }

    fn of_shader(gpu: &Arc<Gpu>, name: &str) -> Result<Self, Error> {
        Ok(Self {
            gpu: Arc::clone(gpu),
            pipeline: ComputePipeline::new(gpu, shader(name))?,
        })
    }

    /// Binds inputs and the image that a recording fills, an R32G32B32A32_SFLOAT storage image:
    /// (value, weight, depth or -1, samples).
    ///
    /// # Errors
    /// Where an input is missing.
    pub fn bind(&self, inputs: &Inputs, accumulation: &Image) -> Result<Bindings, Error> {
        // In place of a depth that is not looked at.
        self.bind_behind(
            inputs,
            accumulation,
            Resource::sampled_or_read(accumulation),
        )
    }

    /// The same behind what a host has drawn: `host_depth` is its depth buffer, a texture as large as the picture, of
    /// which [`super::Recording::behind`] tells the parameters.
    ///
    /// # Errors
    /// Where an input is missing.
    pub fn bind_behind(
        &self,
        inputs: &Inputs,
        accumulation: &Image,
        host_depth: Resource,
    ) -> Result<Bindings, Error> {
        let outputs = [
            ("accumulation", Resource::written(accumulation)),
            ("host_depth", host_depth),
        ];
        inputs.bind(&self.gpu, self.pipeline.layout(), &outputs)
    }

    /// Records one picture, all of it at once, of the parameters at `offset` of the ring.
    ///
    /// # Errors
    /// A picture larger than the device can dispatch.
    ///
    /// # Safety
    /// - `cmd` is recording, outside rendering; what was bound lives until it has run;
    /// - the inputs are in `Use::Sampled`, the image in `Use::ComputeWrite`.
    pub unsafe fn record(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &Bindings,
        offset: u32,
        extent: [u32; 2],
    ) -> Result<(), Error> {
        let whole = [Tile::whole(extent)];
        // SAFETY: the caller's promises.
        unsafe { self.record_tiles(cmd, bindings, offset, extent, whole) }
    }

    /// The same for parts of a picture of `extent`, so that no submission takes long: the parts of a picture may be
    /// spread over several recordings and submissions, in any order, each pixel in one of them. Of several bricks all
    /// are recorded for a pixel in their order; only between those a barrier from `Use::ComputeWrite` to the same is
    /// needed, between parts none.
    ///
    /// # Errors
    /// As [`Self::record`], and corners that are not at multiples of [`Tile::STEP`].
    ///
    /// # Safety
    /// As [`Self::record`].
    pub unsafe fn record_tiles(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &Bindings,
        offset: u32,
        extent: [u32; 2],
        tiles: impl IntoIterator<Item = Tile>,
    ) -> Result<(), Error> {
        for tile in tiles {
            let boxes = [self.pipeline.groups_of(extent, tile)?];
            // SAFETY: the caller's promises; the bindings come from `bind`.
            unsafe {
                self.pipeline
                    .dispatch_boxes(cmd, bindings, &[offset], boxes)
            };
        }
        Ok(())
    }
}
