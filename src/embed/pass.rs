//! The pipelines of a class.

use super::{Class, Error};
use crate::gpu::{Blend, Gpu, TargetClass};
use crate::resolve::{DepthResolve, Resolve};
use crate::technique::blend::Drawn;
use crate::technique::slices_3d::HalfAngleSlicer;
use crate::technique::{ACCUMULATION_FORMAT, Mix, RayPass, Sight, Slicer, Technique, Words};
use std::sync::Arc;

/// How a picture comes into the host's rendering, and its depth.
#[derive(Debug)]
pub(super) struct Pass {
    /// Draws slices: inside the host's rendering, or into an image of our own where that is resolved. `None`: rays.
    pub slicer: Option<Slicer>,
    /// In its place: slices that eye and light see in turn.
    pub half_angle: Option<HalfAngleSlicer>,
    /// Outside of the host's rendering: the picture of rays, or the depth of slices.
    pub rays: Option<RayPass>,
    /// Inside of it: what was gathered outside, to colours.
    pub resolve: Option<Resolve>,
    /// Inside of it: the depth that rays have left.
    pub depth: Option<DepthResolve>,
}

impl Pass {
    /// Compiles all that the class will ever need. `mix` is that of the transfer function.
    pub fn new(gpu: &Arc<Gpu>, class: &Class, words: &Words, mix: Mix) -> Result<Self, Error> {
        let (settings, target) = (&class.settings, class.target);
        let (mode, technique, order) = (settings.mode, settings.technique, settings.order);
        let is_sliced = technique != Technique::Raycast;
        let is_gathered = class.gathers();
        let (drawn_into, sight) = match (is_gathered, class.host_depth) {
            (true, true) => (TargetClass::from(ACCUMULATION_FORMAT), Sight::Read),
            (true, false) => (TargetClass::from(ACCUMULATION_FORMAT), Sight::Open),
            (false, true) => (target, Sight::Tested),
            (false, false) => (target, Sight::Open),
        };
        let slicer = || {
            let drawn = Drawn::Picture(mode);
            Slicer::seen(gpu, technique, drawn, order, words, drawn_into, sight)
        };
        let is_half = settings.is_half_angle();
        let half_angle = || HalfAngleSlicer::new(gpu, words);
        let rays = || match is_sliced {
            false => RayPass::new(gpu, settings, words),
            true => RayPass::along_slices(gpu, settings, words, mix),
        };
        let resolve = || match settings.per_mode.depth_cue == 0.0 {
            true => Resolve::new(gpu, mode, Blend::Over, target),
            false => Resolve::cued(gpu, Blend::Over, target),
        };
        let depth = || DepthResolve::new(gpu, mode, target);
        let has_rays = !is_sliced || class.gives_depth;
        let has_resolve = !is_sliced || is_gathered;
        Ok(Self {
            slicer: (is_sliced && !is_half).then(slicer).transpose()?,
            half_angle: is_half.then(half_angle).transpose()?,
            rays: has_rays.then(rays).transpose()?,
            resolve: has_resolve.then(resolve).transpose()?,
            depth: class.draws_depth().then(depth).transpose()?,
        })
    }
}
