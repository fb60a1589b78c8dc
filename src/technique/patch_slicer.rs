//! The pipelines of a slicer that leaves out patches in which nothing is seen, and, from front to back, squares of the
//! picture that are opaque.
//!
//! ```text
//! patches.record_start                          once a picture
//! for each brick, in order:
//!     record_lists                              outside rendering
//!     for each batch of slices, or all of them:
//!         record_opaque                         outside rendering; from front to back, if at all
//!         record                                inside rendering
//! ```

use super::blend::{Drawn, operator};
use super::{BATCH_SLICES, DepthAccess, Inputs, Order, Patches, ShaderVariant, Technique};
use crate::gpu::{
    Bindings, ComputePipeline, DepthUse, Error, Gpu, Image, RasterDesc, RasterPipeline, Resource,
    Tile, Use, buffer_barrier, set_area_of,
};
use crate::shaders::{LARGEST_BLOCK, MOST_POINT_PIXELS, shader};
use ash::vk;
use std::ops::Range;
use std::sync::Arc;

/// The pipelines that list and draw the patches of one technique.
#[derive(Debug)]
pub struct PatchSlicer {
    gpu: Arc<Gpu>,
    list: ComputePipeline,
    opaque: ComputePipeline,
    draw: RasterPipeline,
    /// In the place of triangles.
    has_points: bool,
}

/// What they read and write.
#[derive(Debug)]
pub struct PatchBindings {
    list: Bindings,
    opaque: Option<Bindings>,
    draw: Bindings,
}

impl PatchSlicer {
    /// Compiles this variant for a target of `format`, as [`super::Slicer::new`].
    ///
    /// # Errors
    /// Where the device does not blend that format, by its name.
    pub fn new(
        gpu: &Arc<Gpu>,
        technique: Technique,
        drawn: Drawn,
        order: Order,
        variant: &ShaderVariant,
        format: vk::Format,
    ) -> Result<Self, Error> {
        let shaders = technique.slice_shaders();
        let (name, list) = (shaders.fragment, shaders.patch_list);
        let has_points = gpu.draws_squares_as_points(MOST_POINT_PIXELS)
            && gpu
                .limits()
                .max_viewport
                .iter()
                .all(|n| n % LARGEST_BLOCK == 0);
        let shape = if has_points { ".points" } else { "" };
        let names = [&format!("slice_patches_cover{shape}"), name];
        let [vertex, fragment] = drawn.shaders(gpu, names, variant, DepthAccess::None);
        let desc = RasterDesc {
            vertex,
            fragment,
            target: format.into(),
            depth: DepthUse::Ignored,
            blend: operator(drawn, order),
        };
        Ok(Self {
            gpu: Arc::clone(gpu),
            list: ComputePipeline::new(gpu, shader(&format!("{list}{shape}")))?,
            opaque: ComputePipeline::new(gpu, shader("opaque_patches"))?,
            draw: match has_points {
                true => RasterPipeline::of_points(gpu, &desc)?,
                false => RasterPipeline::new(gpu, &desc)?,
            },
            has_points,
        })
    }

    /// Binds the inputs, whose [`super::Skip`] says where matter may be, the lists, and the target that slices are
    /// blended in where it is asked what is opaque in it.
    ///
    /// # Errors
    /// Where an input is missing.
    pub fn bind(
        &self,
        inputs: &Inputs,
        patches: &Patches,
        target: Option<&Image>,
    ) -> Result<PatchBindings, Error> {
        let mut others = vec![
            ("draws", Resource::Storage(&patches.draws)),
            ("patches_listed", Resource::Storage(&patches.listed)),
            ("opaque_since", Resource::Storage(&patches.opaque_since)),
        ];
        others.extend(target.map(|target| ("blended", Resource::sampled(target))));
        let bind = |layout| inputs.bind(&self.gpu, layout, &others);
        let opaque = target.map(|_| bind(self.opaque.layout()));
        Ok(PatchBindings {
            list: bind(self.list.layout())?,
            opaque: opaque.transpose()?,
            draw: bind(self.draw.layout())?,
        })
    }

    /// Records what lists the patches of all `slices` of one recording, whose parameters are at `offset` of the ring.
    ///
    /// # Errors
    /// More batches than the device can dispatch.
    ///
    /// # Safety
    /// - `cmd` is recording, outside rendering; what was bound lives until it has run;
    /// - `patches` were bound and hold the room of the view ([`super::View::patch_room`]).
    pub unsafe fn record_lists(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &PatchBindings,
        offset: u32,
        patches: &Patches,
        squares: [u32; 2],
        slices: u32,
    ) -> Result<(), Error> {
        let [across, down] = squares;
        let groups = self
            .list
            .groups([across, down, slices.div_ceil(BATCH_SLICES)])?;
        // SAFETY: the caller's promises; barriers before and after.
        unsafe {
            patches.record_empty(cmd);
            self.list.dispatch(cmd, &bindings.list, &[offset], groups);
            patches.record_listed(cmd);
        }
        Ok(())
    }

    /// Records what finds the squares of the picture that are opaque, before the `batch`-th batch of slices of the
    /// picture, counted from 1 over all bricks: they are left out from here on. Nothing where no target was bound.
    ///
    /// # Errors
    /// More squares than the device can dispatch.
    ///
    /// # Safety
    /// As [`Self::record_lists`]; the target is in `Use::ComputeSampled` and has been blended from front to back.
    pub unsafe fn record_opaque(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &PatchBindings,
        offset: u32,
        patches: &Patches,
        squares: [u32; 2],
        batch: u32,
    ) -> Result<(), Error> {
        let Some(opaque) = &bindings.opaque else {
            return Ok(());
        };
        let [across, down] = squares;
        let groups = self.opaque.groups([across, down, 1])?;
        let since = &patches.opaque_since;
        // SAFETY: the caller's promises; barriers before and after.
        unsafe {
            patches.record_batch_for(cmd, batch, Use::ComputeWrite);
            self.opaque.dispatch(cmd, opaque, &[offset], groups);
            buffer_barrier(&self.gpu, cmd, since, Use::ComputeWrite, Use::DrawRead);
        }
        Ok(())
    }

    /// Records the draw of the patches of `slices`, counted in the order of drawing: whole batches of
    /// [`BATCH_SLICES`], and what is left at the end. Sets viewport and scissor to the whole target.
    ///
    /// # Safety
    /// As [`super::Slicer::record`]; the lists have been recorded before the rendering began.
    pub unsafe fn record(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &PatchBindings,
        offset: u32,
        extent: [u32; 2],
        patches: &Patches,
        slices: Range<u32>,
    ) {
        let area = match self.has_points {
            true => extent.map(|n| n.next_multiple_of(LARGEST_BLOCK)),
            false => extent,
        };
        let batches = slices.start / BATCH_SLICES..slices.end.div_ceil(BATCH_SLICES);
        // SAFETY: the caller's promises; the lists left the draws in `Use::DrawIndirect`.
        unsafe {
            set_area_of(&self.gpu, cmd, area, Tile::whole(extent));
            self.draw
                .draw_indirect(cmd, &bindings.draw, &[offset], &patches.draws, batches);
        }
    }
}
