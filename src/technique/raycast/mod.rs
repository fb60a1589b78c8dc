//! Ray casting: one ray a pixel in a compute pass, emission and absorption front to back (Levoy 1988).

pub mod reference;

use super::inputs::mode_word;
use super::{Inputs, Mix, Mode, Take, Words};
use crate::gpu::{Bindings, ComputePipeline, Error, Gpu, Image, Resource, Tile};
use crate::shaders::shader;
use ash::vk;
use std::sync::Arc;

/// The compute pass.
#[derive(Debug)]
pub struct Raycast {
    gpu: Arc<Gpu>,
    pipeline: ComputePipeline,
}

impl Raycast {
    /// Compiles the variant of these words, for [`Mode::Composite`].
    ///
    /// # Errors
    /// Where the device refuses.
    pub fn new(gpu: &Arc<Gpu>, words: &Words) -> Result<Self, Error> {
        Self::of_mode(gpu, Mode::Composite, words)
    }

    /// The same for a mode that composites: [`Mode::Composite`], or of one volume [`Mode::Mida`] and
    /// [`Mode::Iso`]; surfaces of one volume are coloured by a second one where there are two ([`Mix::Channels`]).
    ///
    /// # Errors
    /// Where the device refuses.
    pub fn of_mode(gpu: &Arc<Gpu>, of: Mode, words: &Words) -> Result<Self, Error> {
        let Words {
            filter,
            holes,
            lattice,
            transfer,
            mix,
            take,
            is_plainly_lit,
        } = words;
        // Kernels, planes and exact control points have the general variant alone.
        let has_lit = of == Mode::Composite
            && *lattice == "ray"
            && *transfer != "points"
            && !matches!(*filter, "kernel" | "spline");
        let mode = mode_word(of);
        let name = match take {
            _ if of == Mode::Iso && *mix == Mix::Channels => {
                format!("isosurface.by.{filter}.{holes}")
            }
            _ if of == Mode::Iso => format!("isosurface.{filter}.{holes}"),
            Take::Slab => format!("raycast_slab.composite.{lattice}.{filter}.{holes}"),
            Take::Point if *is_plainly_lit && has_lit => {
                format!("raycast.composite.lit.ray.{filter}.{holes}.{transfer}")
            }
            _ => format!(
                "raycast.{mode}{}.{lattice}.{filter}.{holes}.{transfer}",
                mix.word()
            ),
        };
        Ok(Self {
            gpu: Arc::clone(gpu),
            pipeline: ComputePipeline::new(gpu, shader(&name))?,
        })
    }

    /// Binds inputs and the two images that a recording fills, both R32G32B32A32_SFLOAT storage images:
    /// `picture` gets premultiplied colour and alpha, `layers` (what the mode keeps, depth or -1,
    /// transmittance, samples).
    ///
    /// # Errors
    /// Where an input is missing.
    pub fn bind(
        &self,
        inputs: &Inputs,
        picture: &Image,
        layers: &Image,
    ) -> Result<Bindings, Error> {
        // In place of a depth that is not looked at.
        self.bind_behind(inputs, picture, layers, Resource::sampled_or_read(layers))
    }

    /// The same behind what a host has drawn: `host_depth` is its depth buffer, a texture as large as the picture, of
    /// which [`super::Recording::behind`] tells the parameters.
    ///
    /// # Errors
    /// Where an input is missing.
    pub fn bind_behind(
        &self,
        inputs: &Inputs,
        picture: &Image,
        layers: &Image,
        host_depth: Resource,
    ) -> Result<Bindings, Error> {
        let outputs = [
            ("picture", Resource::written(picture)),
            ("layers", Resource::written(layers)),
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
    /// - the inputs are in `Use::Sampled`, the images in `Use::ComputeWrite`.
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
