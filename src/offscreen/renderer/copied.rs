//! In which forms volumes are on the device: what pictures read, and nothing beside it.

use crate::resident::{KeptOperator, PayloadFloats, TextureLayout};
use crate::scene::{Beside, Scene};
use crate::technique::{GradientSource, GradientStorage};
use crate::volume::Spline;

/// In which form the volumes are on the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Copied {
    /// Of the textures.
    pub layout: TextureLayout,
    /// Coefficients in place of voxels.
    pub spline: Option<Spline>,
    /// What gradients are made of beside the values.
    pub gradient_source: Option<GradientSource>,
    /// Gradients that are kept.
    pub kept: Option<KeptOperator>,
    /// Footprint texels in place of texels, where there can be any.
    pub is_by_corners: bool,
    /// What voxels are made of, in place of their values.
    pub is_preclassified: bool,
    /// Runs of classified voxels in place of texels, where there can be any.
    pub runs: Option<PayloadFloats>,
}

impl Copied {
    pub fn of(scene: &Scene) -> Self {
        let layout = scene.view(&scene.volume.grid(), [0.0; 2]).texture_layout();
        let gradient_source = scene.settings.gradient_source_beside(layout);
        let kept = match scene.settings.gradient_storage {
            GradientStorage::Precomputed => scene.settings.kept_operator(),
            GradientStorage::OnTheFly | GradientStorage::Auto => None,
        };
        Self {
            kept: kept.filter(|_| scene.has_gradients()),
            layout,
            is_by_corners: scene.settings.reads_footprint_texels_alone(scene.mix())
                && scene.roles().len() == 1,
            is_preclassified: matches!(scene.beside, Beside::Preclassified),
            runs: scene.reads_runs(),
            spline: scene.settings.filter.spline(),
            gradient_source: gradient_source.filter(|_| scene.has_gradients()),
        }
    }
}

impl Copied {
    /// What there is where neither corners nor runs can be had.
    pub fn with_texels(self) -> Self {
        Self {
            is_by_corners: false,
            runs: None,
            ..self
        }
    }
}
