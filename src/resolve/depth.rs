//! The depth of what rays left, into a host's depth buffer: a draw that is legal inside a host's rendering.

use crate::gpu::{
    Bindings, Blend, DepthUse, Error, Gpu, Image, ParameterRing, RasterDesc, RasterPipeline,
    Resource, TargetClass, Tile, set_area_of,
};
use crate::shaders::shader;
use crate::technique::Mode;
use ash::vk;
use std::sync::Arc;

/// The pipeline that writes depth and no colour.
#[derive(Debug)]
pub struct DepthResolve {
    gpu: Arc<Gpu>,
    pipeline: RasterPipeline,
}

impl DepthResolve {
    /// Compiles the variant for what `mode` leaves. `target` has a depth attachment.
    ///
    /// # Errors
    /// Where it has none, or the device has no such attachment.
    pub fn new(gpu: &Arc<Gpu>, mode: Mode, target: TargetClass) -> Result<Self, Error> {
        let fragment = match mode.is_projection() {
            false => "resolve_depth.picture",
            true => "resolve_depth.value",
        };
        let desc = RasterDesc {
            vertex: shader("resolve_cover"),
            fragment: shader(fragment),
            target,
            blend: Blend::Replace,
            depth: DepthUse::Written,
        };
        Ok(Self {
            gpu: Arc::clone(gpu),
            pipeline: RasterPipeline::new(gpu, &desc)?,
        })
    }

    /// Binds what has the depth: what lies beside a composited picture, a projected one itself.
    ///
    /// # Errors
    /// Where the device gives no descriptors.
    pub fn bind(&self, ring: &ParameterRing, left: &Image) -> Result<Bindings, Error> {
        let given = [
            ("frame", Resource::Uniform(ring)),
            ("left", Resource::sampled(left)),
        ];
        Bindings::new(&self.gpu, self.pipeline.layout(), &given)
    }

    /// Records the draw with the parameters at `offset` of the ring, which know of the host's depths
    /// ([`crate::technique::Recording::in_depths_of`]), and sets viewport and scissor to the whole target.
    ///
    /// # Safety
    /// - `cmd` is recording, inside rendering to a target of the pipeline's class and of `extent`;
    /// - what was bound lives until it has run; the image is in `Use::FragmentSampled`.
    pub unsafe fn record(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &Bindings,
        offset: u32,
        extent: [u32; 2],
    ) {
        // SAFETY: the caller's promises; the bindings come from `bind`.
        unsafe {
            set_area_of(&self.gpu, cmd, extent, Tile::whole(extent));
            self.pipeline.draw(cmd, bindings, &[offset], 3, 0..1);
        }
    }
}
