//! The pipelines of a class.

use super::{Class, Error};
use crate::gpu::{Blend, Gpu, TargetClass};
use crate::resolve::{DepthResolve, Resolve};
use crate::technique::blend::Drawn;
use crate::technique::{ACCUMULATION_FORMAT, Mode, RayPass, Slicer, Technique, Words};
use std::sync::Arc;

/// How a picture comes into the host's rendering.
#[derive(Debug)]
pub(super) enum Pass {
    /// Rays outside of it, colours inside.
    Rays {
        pass: RayPass,
        resolve: Resolve,
        depth: Option<DepthResolve>,
    },
    /// Slices inside of it, over what is there.
    Slices(Slicer),
    /// Slices whose numbers are no colours yet: outside of it, colours inside.
    Projected { slicer: Slicer, resolve: Resolve },
}

impl Pass {
    /// Compiles all that the class will ever need.
    pub fn new(gpu: &Arc<Gpu>, class: &Class, words: &Words) -> Result<Self, Error> {
        let (settings, target) = (&class.settings, class.target);
        let (mode, technique, order) = (settings.mode, settings.technique, settings.order);
        let resolve = || match settings.per_mode.depth_cue == 0.0 {
            true => Resolve::new(gpu, mode, Blend::Over, target),
            false => Resolve::cued(gpu, Blend::Over, target),
        };
        let slicer = |target| {
            let drawn = Drawn::Picture(mode);
            Slicer::new(gpu, technique, drawn, order, words, target)
        };
        Ok(match (technique, mode) {
            (Technique::Raycast, _) => Self::Rays {
                pass: RayPass::new(gpu, settings, words)?,
                resolve: resolve()?,
                depth: match class.gives_depth {
                    true => Some(DepthResolve::new(gpu, mode, target)?),
                    false => None,
                },
            },
            (_, Mode::Composite) => Self::Slices(slicer(target)?),
            _ => Self::Projected {
                slicer: slicer(TargetClass::from(ACCUMULATION_FORMAT))?,
                resolve: resolve()?,
            },
        })
    }
}
