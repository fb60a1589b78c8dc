//! What a technique left behind to linear premultiplied colour: a draw that is legal inside a host's rendering.

mod depth;
#[doc(hidden)]
pub mod reference;

pub use depth::DepthResolve;

use crate::gpu::{
    Bindings, Blend, DepthUse, Error, Gpu, Image, ParameterRing, RasterDesc, RasterPipeline,
    Resource, TargetClass, Tile, set_area_of,
};
use crate::resident::GpuTransfer;
use crate::shaders::shader;
use crate::technique::{Mode, Settings};
use ash::vk;
use std::sync::Arc;

/// The pipeline that classifies (or passes on) what a technique left.
#[derive(Debug)]
pub struct Resolve {
    gpu: Arc<Gpu>,
    pipeline: RasterPipeline,
}

impl Resolve {
    /// Compiles the variant for what `mode` leaves, for such targets. Their depth, where they have one, is not asked.
    ///
    /// [`Blend::Replace`] gives the picture itself, [`Blend::Over`] lays it over what a host has drawn.
    ///
    /// # Errors
    /// Where the device does not blend that format, by its name.
    pub fn new(
        gpu: &Arc<Gpu>,
        mode: Mode,
        blend: Blend,
        target: impl Into<TargetClass>,
    ) -> Result<Self, Error> {
        let fragment = match mode {
            Mode::Average => "resolve.mean",
            mode if mode.is_projection() => "resolve.value",
            _ => "resolve.picture",
        };
        Self::of_shader(gpu, fragment, blend, target.into())
    }

    /// The same for a mode that projects one place of each of several rays, whose values are warped to one
    /// ([`shear_warp`](crate::technique::shear_warp)).
    ///
    /// # Errors
    /// Where the device does not blend that format, by its name.
    pub fn covered(
        gpu: &Arc<Gpu>,
        blend: Blend,
        target: impl Into<TargetClass>,
    ) -> Result<Self, Error> {
        Self::of_shader(gpu, "resolve.covered", blend, target.into())
    }

    /// What resolves pictures of these settings.
    ///
    /// # Errors
    /// Where the device does not blend that format, by its name.
    pub(crate) fn of_settings(
        gpu: &Arc<Gpu>,
        settings: &Settings,
        blend: Blend,
        target: impl Into<TargetClass>,
    ) -> Result<Self, Error> {
        let Settings {
            technique, mode, ..
        } = *settings;
        match mode.projects_one_place() {
            true if settings.per_mode.depth_cue != 0.0 => Self::cued(gpu, blend, target),
            true if technique.is_warped() => Self::covered(gpu, blend, target),
            _ => Self::new(gpu, mode, blend, target),
        }
    }

    /// The same for a mode that projects one place of a ray, darker with its depth.
    ///
    /// # Errors
    /// Where the device does not blend that format, by its name.
    pub fn cued(
        gpu: &Arc<Gpu>,
        blend: Blend,
        target: impl Into<TargetClass>,
    ) -> Result<Self, Error> {
        Self::of_shader(gpu, "resolve.cued", blend, target.into())
    }

    fn of_shader(
        gpu: &Arc<Gpu>,
        fragment: &str,
        blend: Blend,
        target: TargetClass,
    ) -> Result<Self, Error> {
        let desc = RasterDesc {
            vertex: shader("resolve_cover"),
            fragment: shader(fragment),
            target,
            blend,
            depth: DepthUse::Ignored,
        };
        Ok(Self {
            gpu: Arc::clone(gpu),
            pipeline: RasterPipeline::new(gpu, &desc)?,
        })
    }

    /// Binds what a technique left. Projecting modes need the transfer function.
    ///
    /// # Errors
    /// Where it is missing.
    pub fn bind(
        &self,
        ring: &ParameterRing,
        accumulation: &Image,
        transfer: Option<&GpuTransfer>,
    ) -> Result<Bindings, Error> {
        let left = Resource::sampled(accumulation);
        let mut given = vec![
            ("frame", Resource::Uniform(ring)),
            ("picture", left),
            ("accumulation", left),
        ];
        given.extend(
            transfer.map(|transfer| ("transfer_numbers", Resource::Storage(transfer.numbers()))),
        );
        given.retain(|(name, _)| {
            self.pipeline
                .layout()
                .slots()
                .iter()
                .any(|slot| slot.name == *name)
        });
        Bindings::new(&self.gpu, self.pipeline.layout(), &given)
    }

    /// Records the draw with the parameters at `offset` of the ring, and sets viewport and scissor to the whole
    /// target.
    ///
    /// # Safety
    /// - `cmd` is recording, inside rendering to one target of the pipeline's format and of `extent`;
    /// - what was bound lives until it has run; the accumulation is in `Use::FragmentSampled`.
    pub unsafe fn record(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &Bindings,
        offset: u32,
        extent: [u32; 2],
    ) {
        // SAFETY: the caller's promises.
        unsafe { self.record_tile(cmd, bindings, offset, extent, Tile::whole(extent)) };
    }

    /// The same for a part of a picture of `extent`: parts may be drawn in any order and in any submissions.
    ///
    /// # Safety
    /// As [`Self::record`]; the rendering covers the tile.
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
