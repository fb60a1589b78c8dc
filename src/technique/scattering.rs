//! Light that matter scatters once on its way to the eye, without noise: in place of its colour a sample of a ray has
//!
//! ```text
//! S = albedo (sum over lights of p(c) E T + T_sky sky)        E = pi colour,  c between the directions of travel
//! ```
//!
//! and of a point pi colour d^2 times the mean of 1 / r^2 over the segment that the sample stands for.
//! p is the phase function, T what comes through from a light, T_sky the mean of that over all directions. Medium, lights
//! and sky are those of paths ([`PathTracing`]): with one bounce they estimate the same picture.
//!
//! [`PathTracing`]: super::pathtrace::PathTracing

use super::{Error, Lattice, Settings, View};
use crate::shaders::FrameFields;
use crate::transfer::{Absorption, TransferFunction};

/// How light comes to matter that scatters it once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SingleScattering {
    /// Nothing is in its way.
    Open,
    /// It is followed once through a coarse grid ([`LightPlan`](super::LightPlan)).
    #[default]
    Volume,
    /// Lights are followed from each sample on, by steps as long as those of rays; the sky through the coarse grid.
    March,
}

/// Of light that is followed from samples no more than 2^-13 is left out: 13 ln 2.
const DARK: f32 = 9.010_913;

impl Settings {
    /// What single scattering multiplies extinctions by; 1 without it.
    pub(crate) fn density_of_rays(&self) -> f64 {
        match self.single_scattering {
            Some(_) => self.path.density,
            None => 1.0,
        }
    }

    /// Whether matter scatters light, once or more often.
    pub(crate) fn scatters(&self) -> bool {
        self.single_scattering.is_some() || self.technique.traces_paths()
    }

    /// How a function takes light away, where opacities are for `default_length` unless it says for which; of matter that
    /// scatters by what it says of that.
    pub(crate) fn absorption(
        &self,
        function: &TransferFunction,
        default_length: f64,
    ) -> Absorption {
        let reference_length = function.reference_length.unwrap_or(default_length);
        let density = self.density_of_rays();
        match self.scatters() && function.medium.is_some() {
            true => Absorption::Medium {
                reference_length,
                density,
            },
            false => Absorption::Extinction {
                reference_length: reference_length / density,
            },
        }
    }

    /// Whether matter takes light of the sky away.
    pub(super) fn has_hindered_sky(&self) -> bool {
        let is_hindered = self
            .single_scattering
            .is_some_and(SingleScattering::hinders);
        is_hindered && self.path.sky.iter().any(|&c| c > 0.0)
    }
}

impl SingleScattering {
    fn hinders(self) -> bool {
        self != Self::Open
    }
}

impl View<'_> {
    /// The parameters of light that is scattered once.
    pub(super) fn set_scattering(
        &self,
        scattering: SingleScattering,
        fields: &mut FrameFields,
    ) -> Result<(), Error> {
        self.set_paths(fields)?;
        fields.scattering_depth = match scattering {
            SingleScattering::Open | SingleScattering::Volume => 0.0,
            SingleScattering::March if self.settings.conformance => f32::MAX,
            SingleScattering::March => DARK,
        };
        fields.least_slope = match self.settings.lattice {
            Lattice::Planes => 0.0,
            Lattice::Ray | Lattice::Jitter | Lattice::Bresenham => 1.0,
        };
        Ok(())
    }
}
