//! The pipelines of a class.

use super::class::SliceBlending;
use super::{Class, Error};
use crate::gpu::{Blend, Gpu};
use crate::resolve::{DepthResolve, Resolve};
use crate::technique::blend::Drawn;
use crate::technique::slices_3d::HalfAngleSlicer;
use crate::technique::{Mix, RayPass, SliceGather, Slicer, Words};
use std::sync::Arc;

/// How a picture comes into the host's rendering, and its depth.
#[derive(Debug)]
pub(super) struct Pass {
    /// Draws slices. `None`: rays, or half-angle slices.
    pub slices: Option<Slices>,
    /// Draws slices that eye and light see in turn.
    pub half_angle: Option<HalfAngleSlicer>,
    /// Outside of the host's rendering: the picture of rays, or the depth of slices.
    pub rays: Option<RayPass>,
    /// Inside of it: what was gathered outside, to colours.
    pub resolve: Option<Resolve>,
    /// Inside of it: the depth that rays have left.
    pub depth: Option<DepthResolve>,
}

/// Where slices are drawn.
#[derive(Debug)]
pub(super) enum Slices {
    /// Outside of the host's rendering, into an image of our own.
    Gathered(Box<SliceGather>),
    /// Inside of it, into the host's target.
    InTarget(Slicer),
}

impl Pass {
    /// Compiles all that the class will ever need. `mix` is that of the transfer function.
    pub fn new(gpu: &Arc<Gpu>, class: &Class, words: &Words, mix: Mix) -> Result<Self, Error> {
        let (settings, target) = (&class.settings, class.target);
        let (mode, technique, order) = (settings.mode, settings.technique, settings.order);
        let is_sliced = !technique.casts_rays();
        let slices = || -> Result<Slices, crate::gpu::Error> {
            let (drawn, sight) = (Drawn::Picture(mode), class.sight());
            Ok(match class.slice_blending {
                SliceBlending::Float => {
                    let made = SliceGather::new(gpu, settings, drawn, words, sight)?;
                    Slices::Gathered(Box::new(made))
                }
                SliceBlending::InTarget => {
                    let made = Slicer::seen(gpu, technique, drawn, order, words, target, sight)?;
                    Slices::InTarget(made)
                }
            })
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
        let has_resolve = !is_sliced || class.gathers();
        Ok(Self {
            slices: (is_sliced && !is_half).then(slices).transpose()?,
            half_angle: is_half.then(half_angle).transpose()?,
            rays: has_rays.then(rays).transpose()?,
            resolve: has_resolve.then(resolve).transpose()?,
            depth: class.draws_depth().then(depth).transpose()?,
        })
    }
}
