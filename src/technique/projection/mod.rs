//! MIP and its relatives: one ray a pixel in a compute pass, one number a ray.

#[doc(hidden)]
pub mod exact;
#[doc(hidden)]
pub mod reference;

use super::ray_tiles::{Nothing, TilePass};
use super::{Inputs, Mode, RayBindings, RayTiles, ShaderVariant};
use crate::gpu::{Error, Gpu, Image, Resource, Tile};
use crate::shaders::{Shader, shader};
use ash::vk;
use std::sync::Arc;

/// The compute pass of one mode.
#[derive(Debug)]
pub struct Projection {
    pass: TilePass,
}

impl Projection {
    /// Compiles this variant for the mode.
    ///
    /// # Errors
    /// Where the device refuses.
    pub fn new(gpu: &Arc<Gpu>, mode: Mode, variant: &ShaderVariant) -> Result<Self, Error> {
        let ShaderVariant {
            filter,
            holes,
            lattice,
            ..
        } = variant;
        let name = format!(
            "projection.{}.{lattice}.{filter}.{holes}",
            mode.shader_key()
        );
        Self::of_rays(gpu, variant.shader(&name))
    }

    /// The same for the exact extreme of the trilinear field, of [`Mode::Mip`] or [`Mode::Minip`].
    ///
    /// # Errors
    /// Where the device refuses.
    pub fn exact(gpu: &Arc<Gpu>, mode: Mode, variant: &ShaderVariant) -> Result<Self, Error> {
        let name = format!("projection_cells.{}.{}", mode.shader_key(), variant.holes);
        Self::of_shader(gpu, &name)
    }

    /// Rays of another kind that leave one number a ray.
    pub(super) fn of_shader(gpu: &Arc<Gpu>, name: &str) -> Result<Self, Error> {
        Self::of_rays(gpu, shader(name))
    }

    /// The same of what may be seen outside of the box of the volume too.
    pub(super) fn everywhere(gpu: &Arc<Gpu>, name: &str) -> Result<Self, Error> {
        Ok(Self {
            pass: TilePass::new(gpu, shader(name), Nothing::NowhereOfProjection)?,
        })
    }

    fn of_rays(gpu: &Arc<Gpu>, rays: &Shader) -> Result<Self, Error> {
        Ok(Self {
            pass: TilePass::new(gpu, rays, Nothing::BeyondProjection)?,
        })
    }

    /// Binds inputs and the image that a recording fills, an R32G32B32A32_SFLOAT storage image:
    /// (value, weight, depth or -1, samples). `tiles` has room for as many pixels, and is used by no unfinished
    /// recording.
    ///
    /// # Errors
    /// Where an input is missing.
    pub fn bind(
        &self,
        inputs: &Inputs,
        accumulation: &Image,
        tiles: &RayTiles,
    ) -> Result<RayBindings, Error> {
        // In place of a depth that is not looked at.
        let depth = Resource::sampled_or_read(accumulation);
        self.bind_behind(inputs, accumulation, tiles, depth)
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
        tiles: &RayTiles,
        host_depth: Resource,
    ) -> Result<RayBindings, Error> {
        let images = [("accumulation", accumulation)];
        self.pass.bind(inputs, tiles, &images, host_depth)
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
        bindings: &RayBindings,
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
        bindings: &RayBindings,
        offset: u32,
        extent: [u32; 2],
        tiles: impl IntoIterator<Item = Tile>,
    ) -> Result<(), Error> {
        // SAFETY: the caller's promises; the bindings come from `bind`.
        unsafe { self.pass.record(cmd, bindings, offset, extent, tiles) }
    }
}
