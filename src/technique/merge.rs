//! Slicing on a device that does not blend R32G32B32A32_SFLOAT (`sampling.md` 5): batches of slices are blended
//! in R16G16B16A16_SFLOAT, which every device blends, and merged in f32 by a compute pass.

use super::blend::Drawn;
use super::{ACCUMULATION_FORMAT, Mode, Order};
use crate::gpu::{Bindings, Blend, ComputePipeline, Error, Gpu, Image, Resource, Tile};
use crate::shaders::shader;
use ash::vk;
use std::sync::Arc;

/// Slices of one batch. The specification allows 512, which keeps an 8-bit code where blending rounds to nearest
/// (`sampling.md` 5); blending that truncates, as lavapipe's does, needs batches of an eighth.
pub const MAX_BATCH_SLICES: u32 = 64;

/// The format of a batch.
pub const BATCH_FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

/// Whether slices that are `drawn` for this are blended in batches on this device: only compositing and counting can be,
/// for a maximum or a sum of 16-bit floats is not that of the values.
pub(crate) fn is_merged(gpu: &Gpu, drawn: Drawn) -> bool {
    let can_merge = matches!(drawn, Drawn::Picture(Mode::Composite) | Drawn::Count);
    can_merge && !gpu.format_features(ACCUMULATION_FORMAT).blend
}

/// The compute pass that lays a batch onto what earlier ones have left.
#[derive(Debug)]
pub struct Merge {
    gpu: Arc<Gpu>,
    pipeline: ComputePipeline,
}

impl Merge {
    /// Compiles the operator that `drawn` slices are put together with. Only compositing and counting can be
    /// merged: a maximum or a sum of 16-bit floats is not that of the values.
    ///
    /// # Errors
    /// Where the device refuses.
    pub fn new(gpu: &Arc<Gpu>, drawn: Drawn, order: Order) -> Result<Self, Error> {
        let name = match super::blend::operator(drawn, order) {
            Blend::Over => "merge.over",
            Blend::Under => "merge.under",
            _ => "merge.add",
        };
        Ok(Self {
            gpu: Arc::clone(gpu),
            pipeline: ComputePipeline::new(gpu, shader(name))?,
        })
    }

    /// Binds a batch and the R32G32B32A32_SFLOAT storage image that gathers them.
    ///
    /// # Errors
    /// None but a mistake of ours.
    pub fn bind(&self, batch: &Image, accumulation: &Image) -> Result<Bindings, Error> {
        let given = [
            ("batch", Resource::sampled(batch)),
            ("accumulation", Resource::written(accumulation)),
        ];
        Bindings::new(&self.gpu, self.pipeline.layout(), &given)
    }

    /// Records the merge of one batch.
    ///
    /// # Errors
    /// A picture larger than the device can dispatch.
    ///
    /// # Safety
    /// - `cmd` is recording, outside rendering; what was bound lives until it has run;
    /// - the batch is in `Use::ComputeSampled`, the accumulation, all zeros before the first batch, in
    ///   `Use::ComputeWrite`.
    pub unsafe fn record(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &Bindings,
        extent: [u32; 2],
    ) -> Result<(), Error> {
        let whole = Tile::whole(extent);
        // SAFETY: the caller's promises.
        unsafe { self.record_tile(cmd, bindings, extent, whole) }
    }

    /// The same for a part of a picture of `extent`, as [`super::Slicer::record_tile`] draws it.
    ///
    /// # Errors
    /// As [`Self::record`], and corners that are not at multiples of [`Tile::STEP`].
    ///
    /// # Safety
    /// As [`Self::record`].
    pub unsafe fn record_tile(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &Bindings,
        extent: [u32; 2],
        tile: Tile,
    ) -> Result<(), Error> {
        let boxes = [self.pipeline.groups_of(extent, tile)?];
        // SAFETY: the caller's promises; the bindings come from `bind`.
        unsafe { self.pipeline.dispatch_boxes(cmd, bindings, &[], boxes) };
        Ok(())
    }
}
