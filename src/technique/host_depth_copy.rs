//! A host's depth buffer in a depth attachment of ours, so that slices that are gathered in an image of ours are tested
//! against it by the device.
//!
//! ```text
//! own = depth        where the host's larger depth is the nearer one
//! own = 1 - depth    else: in the copy the larger depth is always nearer
//! ```

use crate::gpu::{
    Bindings, Blend, DEPTH_FORMAT, DepthClass, DepthUse, Error, Gpu, Image, ImageDesc, ImageKind,
    ParameterRing, RasterDesc, RasterPipeline, Resource, TargetClass, Tile, set_area_of,
};
use crate::shaders::shader;
use ash::vk;
use std::sync::Arc;

/// The copy's depth where the host has drawn nothing.
pub const FARTHEST: f32 = 0.0;

/// The pipeline that fills the copy. It writes depth and no colour.
#[derive(Debug)]
pub struct HostDepthCopy {
    gpu: Arc<Gpu>,
    pipeline: RasterPipeline,
}

impl HostDepthCopy {
    /// A target of that colour format with the copy as its depth attachment.
    pub fn target(color_format: vk::Format) -> TargetClass {
        TargetClass {
            depth: Some(DepthClass {
                format: DEPTH_FORMAT,
                has_stencil: false,
                is_reversed: true,
            }),
            ..color_format.into()
        }
    }

    /// Compiles it for a rendering to [`HostDepthCopy::target`] of that format.
    ///
    /// # Errors
    /// Where the device has no such depth attachment.
    pub fn new(gpu: &Arc<Gpu>, color_format: vk::Format) -> Result<Self, Error> {
        let desc = RasterDesc {
            vertex: shader("resolve_cover"),
            fragment: shader("host_depth_copy"),
            target: Self::target(color_format),
            blend: Blend::Replace,
            depth: DepthUse::Written,
        };
        Ok(Self {
            gpu: Arc::clone(gpu),
            pipeline: RasterPipeline::new(gpu, &desc)?,
        })
    }

    /// The depth attachment, of `extent` pixels.
    ///
    /// # Errors
    /// An extent over a limit of the device, no memory.
    pub fn image(gpu: &Arc<Gpu>, [width, height]: [u32; 2]) -> Result<Image, Error> {
        let desc = ImageDesc {
            kind: ImageKind::D2,
            extent: [width, height, 1],
            format: DEPTH_FORMAT,
            usage: vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT,
            name: "copy of the host's depth",
        };
        Image::new(gpu, &desc)
    }

    /// Binds the host's depth buffer, a texture as large as the picture.
    ///
    /// # Errors
    /// Where the device gives no descriptors.
    pub fn bind(&self, ring: &ParameterRing, host_depth: Resource) -> Result<Bindings, Error> {
        let given = [
            ("frame", Resource::Uniform(ring)),
            ("host_depth", host_depth),
        ];
        Bindings::new(&self.gpu, self.pipeline.layout(), &given)
    }

    /// Records the draw with the parameters at `offset` of the ring ([`super::Recording::tested_in_copy`]).
    ///
    /// # Safety
    /// - `cmd` is recording, inside rendering to a target of the pipeline's class that covers the tile, whose depth is
    ///   [`FARTHEST`];
    /// - what was bound lives until it has run, and the host's depth buffer is visible to fragment shaders.
    pub unsafe fn record_tile(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &Bindings,
        offset: u32,
        extent: [u32; 2],
        tile: Tile,
    ) {
        // SAFETY: the caller's promises; the bindings come from `bind`.
        unsafe {
            set_area_of(&self.gpu, cmd, extent, tile);
            self.pipeline.draw(cmd, bindings, &[offset], 3, 0..1);
        }
    }
}
