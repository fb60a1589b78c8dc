//! The pipeline of a slicer: its cover in the vertex shader, its samples in the fragment shader, its operator in
//! the blending unit, all slices of a picture in one instanced draw.

use super::blend::{Drawn, operator};
use super::{Inputs, Mode, Order, Settings, ShaderVariant, Technique};
use crate::gpu::{
    Bindings, DepthUse, Error, Gpu, RasterDesc, RasterPipeline, Resource, TargetClass, Tile,
    set_area_of,
};
use ash::vk;
use std::ops::Range;
use std::sync::Arc;

/// A blending unit has one number a channel: no mode in which a sample depends on those before it.
pub(super) fn slicer_supports(settings: &Settings) -> Result<(), super::Error> {
    let Settings {
        technique, mode, ..
    } = *settings;
    match mode.needs_rays() {
        true => Err(super::Error::NeedsRays { technique, mode }),
        false => Ok(()),
    }
}

/// What hides samples of slices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthAccess {
    /// Nothing.
    None,
    /// The depth attachment of the rendering, slice by slice.
    Tested,
    /// What a host has drawn, read from an image ([`Slicer::bind_behind`]): of projections, which are drawn into an
    /// image that has no depth attachment, and of slabs, which reach out of the slices that would be tested.
    Sampled,
}

impl DepthAccess {
    /// Of slices behind what a host has drawn. Slabs, which reach out of the slices that would be tested, and projections
    /// read the host's depth.
    pub fn behind(settings: &Settings) -> Self {
        match settings.mode != Mode::Composite || settings.preintegrated {
            true => Self::Sampled,
            false => Self::Tested,
        }
    }
}

/// The pipeline that draws the slices of one technique.
#[derive(Debug)]
pub struct Slicer {
    gpu: Arc<Gpu>,
    pipeline: RasterPipeline,
    vertices_per_slice: u32,
}

impl Slicer {
    /// Compiles this variant for such targets: the slices of `technique`, which casts no rays. Where the
    /// rendering has a depth attachment, what a host has drawn hides what lies behind it
    /// ([`super::Recording::tested_in`]).
    ///
    /// # Errors
    /// Where the device does not blend that format, by its name.
    pub fn new(
        gpu: &Arc<Gpu>,
        technique: Technique,
        drawn: Drawn,
        order: Order,
        variant: &ShaderVariant,
        target: impl Into<TargetClass>,
    ) -> Result<Self, Error> {
        let target = target.into();
        let depth_access = match target.depth {
            Some(_) => DepthAccess::Tested,
            None => DepthAccess::None,
        };
        Self::seen(gpu, technique, drawn, order, variant, target, depth_access)
    }

    /// The same with another word on what hides samples.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn seen(
        gpu: &Arc<Gpu>,
        technique: Technique,
        drawn: Drawn,
        order: Order,
        variant: &ShaderVariant,
        target: TargetClass,
        depth_access: DepthAccess,
    ) -> Result<Self, Error> {
        let shaders = technique.slice_shaders();
        let names = [shaders.cover, shaders.fragment];
        let [vertex, fragment] = drawn.shaders(gpu, names, variant, depth_access);
        let desc = RasterDesc {
            vertex,
            fragment,
            target,
            depth: match depth_access {
                DepthAccess::Tested => DepthUse::Tested,
                DepthAccess::None | DepthAccess::Sampled => DepthUse::Ignored,
            },
            blend: operator(drawn, order),
        };
        Ok(Self {
            gpu: Arc::clone(gpu),
            pipeline: RasterPipeline::new(gpu, &desc)?,
            vertices_per_slice: shaders.vertices_per_slice,
        })
    }

    /// Binds the inputs.
    ///
    /// # Errors
    /// Where an input is missing.
    pub fn bind(&self, inputs: &Inputs) -> Result<Bindings, Error> {
        inputs.bind(&self.gpu, self.pipeline.layout(), &[])
    }

    /// The same for [`DepthAccess::Sampled`]: `host_depth` is the host's depth buffer, a texture as large as the picture, of
    /// which [`super::Recording::behind`] tells the parameters.
    ///
    /// # Errors
    /// Where an input is missing.
    pub fn bind_behind(&self, inputs: &Inputs, host_depth: Resource) -> Result<Bindings, Error> {
        let host_depth = [("host_depth", host_depth)];
        inputs.bind(&self.gpu, self.pipeline.layout(), &host_depth)
    }

    /// Records the draw of `slices`, counted in the order of drawing, of the parameters at `offset` of the ring,
    /// and sets viewport and scissor to the whole target.
    ///
    /// The target holds [`super::blend::clear_color`] before. Compositing from back to front also goes over
    /// premultiplied colour that a host has drawn.
    ///
    /// # Safety
    /// - `cmd` is recording, inside rendering to one target of the pipeline's format and of `extent`;
    /// - what was bound lives until it has run; the inputs are in `Use::Sampled`.
    pub unsafe fn record(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &Bindings,
        offset: u32,
        extent: [u32; 2],
        slices: Range<u32>,
    ) {
        // SAFETY: the caller's promises.
        unsafe {
            self.record_tile(cmd, bindings, offset, extent, slices, Tile::whole(extent));
        }
    }

    /// The same for a part of a picture of `extent`, so that no submission takes long. Two ways to cut, alone or both:
    ///
    /// - tiles in any order and in any submissions, each pixel in one of them, with all its bricks and slices in
    ///   their order. Rendering may be begun for the tile alone, which clears no more than that
    ///   ([`crate::gpu::begin_rendering_of`]);
    /// - runs of `slices`, one after the other. A rendering of its own for each loads what the one before has stored,
    ///   after a barrier from `Use::ColorTarget` to the same.
    ///
    /// # Safety
    /// As [`Self::record`]; the rendering covers the tile.
    pub unsafe fn record_tile(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &Bindings,
        offset: u32,
        extent: [u32; 2],
        slices: Range<u32>,
        tile: Tile,
    ) {
        // SAFETY: the caller's promises; the bindings come from `bind`.
        unsafe {
            set_area_of(&self.gpu, cmd, extent, tile);
            let vertices = self.vertices_per_slice;
            self.pipeline
                .draw(cmd, bindings, &[offset], vertices, slices);
        }
    }
}
