//! Classified voxels of shear-warp, which lie in runs.

use super::Renderer;
use super::copied::Copied;
use crate::gpu::Headless;
use crate::offscreen::Error;
use crate::offscreen::stream::if_it_fits;
use crate::offscreen::upload::fill;
use crate::resident::{ClassifiedRuns, GpuVolume, MadeBy, PayloadFloats, RunsSize};
use crate::scene::Scene;
use crate::technique::{Filter, FilterBy, Technique};
use crate::volume::Volume;

impl Scene<'_> {
    /// In which floats pictures of the scene read runs of classified voxels, where there can be any; `None` where they read
    /// textures: those of other techniques, of samples between slices, of light that matter hinders, and those by a sampler that
    /// was asked for.
    pub(super) fn reads_runs(&self) -> Option<PayloadFloats> {
        let settings = self.settings;
        let is_such = settings.technique == Technique::ShearWarp
            && self.is_classified()
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
    /// Brings runs of what the voxels are made of, and no texels: whether they can have any. The device makes them where there are
    /// codes and it has room, else the host.
    ///
    /// # Errors
    /// Where the device is lost, and where what voxels are made of makes no volumes.
    pub(super) fn upload_runs(
        &mut self,
        copied: Copied,
        floats: PayloadFloats,
    ) -> Result<bool, Error> {
        let device = &mut self.device;
        let coded = match copied.is_preclassified {
            true => self.preclassified.runs(device, self.volumes[0], floats)?,
            false => None,
        };
        let made = match coded {
            Some((runs, outlines)) => of_runs(device, outlines.each_ref(), runs)?,
            None => {
                self.make_volumes(copied)?;
                let volumes = self.preclassified.read(copied, &self.volumes);
                let [red, green, blue, depth] = volumes[..] else {
                    return Ok(false);
                };
                let volumes = [red, green, blue, depth];
                let device = &mut self.device;
                match if_it_fits(ClassifiedRuns::new(device, volumes, floats))?.flatten() {
                    Some(runs) => of_runs(device, volumes, runs)?,
                    None => None,
                }
            }
        };
        let is_made = made.is_some();
        self.resident.extend(made.map(|made| (copied, made)));
        Ok(is_made)
    }

    /// The runs that the last picture read; `None` where it read none.
    pub fn runs(&self) -> Option<RunsSize> {
        self.runs_read().map(ClassifiedRuns::size)
    }

    /// Who made them.
    pub fn runs_made_by(&self) -> Option<MadeBy> {
        self.runs_read().map(ClassifiedRuns::made_by)
    }

    fn runs_read(&self) -> Option<&ClassifiedRuns> {
        let (.., variant) = self.passes.as_ref()?.key();
        let mut there = self.resident.values().flatten();
        there
            .find_map(GpuVolume::runs)
            .filter(|_| variant.is_in_runs)
    }
}

/// The four volumes in runs, with where they have data; `None` where there is no room.
fn of_runs(
    device: &mut Headless,
    volumes: [&Volume; 4],
    runs: ClassifiedRuns,
) -> Result<Option<Vec<GpuVolume>>, Error> {
    let Some(made) = if_it_fits(GpuVolume::of_runs(device.gpu(), volumes, runs))? else {
        return Ok(None);
    };
    for (made, volume) in made.iter().zip(volumes) {
        fill(device, made, volume)?;
    }
    Ok(Some(made))
}
