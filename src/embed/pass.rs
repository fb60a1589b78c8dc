//! The pipelines of a class.

use super::noise::NoisePass;
use super::renderer_desc::SliceBlending;
use super::{Error, RendererDesc};
use crate::gpu::{Blend, Gpu};
use crate::resolve::{DepthResolve, Resolve};
use crate::technique::blend::Drawn;
use crate::technique::gather::{Gather, GatherDesc, depth_of_slices};
use crate::technique::{SampleInputs, ShaderVariant, Slicer};
use std::sync::Arc;

/// How a picture comes into the host's rendering, and its depth.
#[derive(Debug)]
pub(super) struct Pass {
    /// Outside of the host's rendering: what makes the picture.
    pub picture: Option<Box<dyn Gather>>,
    /// Outside of it too: the depth of slices.
    pub slice_depth: Option<Box<dyn Gather>>,
    /// Outside of it, behind paths: how noisy what they have added up to is.
    pub noise: Option<NoisePass>,
    /// Inside of it: slices that are blended in the host's target.
    pub in_target: Option<Slicer>,
    /// Inside of it: what was gathered outside, to colours.
    pub resolve: Option<Resolve>,
    /// Inside of it: the depth that rays have left.
    pub depth: Option<DepthResolve>,
}

impl Pass {
    /// Compiles all that the class will ever need. `mix` is that of the transfer function.
    pub fn new(
        gpu: &Arc<Gpu>,
        class: &RendererDesc,
        variant: &ShaderVariant,
        mix: SampleInputs,
    ) -> Result<Self, Error> {
        let (settings, target, depth_access) =
            (&class.settings, class.target, class.depth_access());
        let (mode, technique, order) = (settings.mode, settings.technique, settings.order);
        let drawn = Drawn::Picture(mode);
        let desc = GatherDesc {
            gpu,
            settings,
            variant,
            drawn,
            depth_access,
            is_patched: false,
        };
        let is_in_target = class.slice_blending == SliceBlending::InTarget;
        let slicer = || Slicer::seen(gpu, technique, drawn, order, variant, target, depth_access);
        let picture = || (technique.desc().gather)(&desc);
        let finds_depth = !technique.casts_rays() && class.finds_depth();
        let slice_depth = || depth_of_slices(&desc, mix);
        let noise = || NoisePass::new(gpu);
        let resolve = || Resolve::of_settings(gpu, settings, Blend::Over, target);
        let depth = || DepthResolve::new(gpu, mode, target);
        Ok(Self {
            picture: (!is_in_target).then(picture).transpose()?,
            slice_depth: finds_depth.then(slice_depth).transpose()?,
            noise: technique.traces_paths().then(noise).transpose()?,
            in_target: is_in_target.then(slicer).transpose()?,
            resolve: (!is_in_target).then(resolve).transpose()?,
            depth: class.draws_depth().then(depth).transpose()?,
        })
    }
}
