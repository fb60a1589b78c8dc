//! Classified voxels of shear-warp, which lie in runs.

use super::Renderer;
use super::copied::Copied;
use crate::offscreen::Error;
use crate::offscreen::stream::if_it_fits;
use crate::offscreen::upload::fill;
use crate::resident::{ClassifiedRuns, GpuVolume, PayloadFloats, RunsSize};
use crate::scene::{Beside, Scene};
use crate::technique::{Filter, FilterBy, Technique};

impl Scene<'_> {
    /// In which floats pictures of the scene read runs of classified voxels, where there can be any; `None` where they read
    /// textures: those of other techniques, of samples between slices, of light that matter hinders, and those by a sampler that
    /// was asked for.
    pub(super) fn reads_runs(&self) -> Option<PayloadFloats> {
        let settings = self.settings;
        let is_such = settings.technique == Technique::ShearWarp
            && matches!(self.beside, Beside::Classified(_))
            && matches!(settings.filter, Filter::Nearest | Filter::Linear)
            && settings.samples_per_voxel == 1.0
            && (settings.filter_by != FilterBy::Sampler || settings.conformance)
            && !settings.wants_light_volume();
        is_such.then_some(match settings.conformance {
            true => PayloadFloats::Single,
            false => PayloadFloats::Half,
        })
    }
}

impl Renderer<'_> {
    /// Brings the runs of the four volumes, and no texels: whether they can have any.
    ///
    /// # Errors
    /// Where the device is lost.
    pub(super) fn upload_runs(&mut self, copied: Copied) -> Result<bool, Error> {
        let (Some(floats), &[red, green, blue, depth]) = (copied.runs, &self.volumes[..]) else {
            return Ok(false);
        };
        let volumes = [red, green, blue, depth];
        let made = ClassifiedRuns::new(&mut self.device, volumes, floats);
        let Some(runs) = if_it_fits(made)?.flatten() else {
            return Ok(false);
        };
        let made = GpuVolume::of_runs(self.device.gpu(), volumes, runs);
        let Some(made) = if_it_fits(made)? else {
            return Ok(false);
        };
        for (made, volume) in made.iter().zip(volumes) {
            fill(&mut self.device, made, volume)?;
        }
        self.resident.insert(copied, made);
        Ok(true)
    }

    /// The runs that the last picture read; `None` where it read none.
    pub fn runs(&self) -> Option<RunsSize> {
        let (.., variant) = self.passes.as_ref()?.key();
        let mut there = self.resident.values().flatten();
        let runs = there.find_map(GpuVolume::runs)?;
        variant.is_in_runs.then(|| runs.size())
    }
}
