//! What classifies and lights the samples of a scene, on the device and made anew only where it changes.

use super::{Classifying, Renderer, parts_of};
use crate::offscreen::Error;
use crate::offscreen::light::{Matter, light_plan_of, made_light, matter_count};
use crate::resident::GpuTransfer;
use crate::scene::Scene;
use crate::technique;
use crate::technique::Settings;
use crate::transfer::TransferFunction;

impl Renderer<'_> {
    /// Puts on the device what classifies samples, and follows light through it where pictures of `scene` ask for
    /// that. Nothing to do where both are there.
    ///
    /// # Errors
    /// Where no function says what samples are made of, or the device gives no memory.
    pub fn prepare_light(&mut self, scene: &Scene) -> Result<(), Error> {
        let scene = &scene.under_labels();
        let grid = scene.volume.grid();
        let view = scene.view(&grid, [0.0; 2]);
        let plan = light_plan_of(scene, &view)?;
        let surfaces = view.matter_of_surfaces();
        let functions: Option<Vec<_>> = match &surfaces {
            Some(_) if plan.is_none() => return Ok(()),
            Some(function) => Some(vec![function]),
            None => scene.transfers().into_iter().collect(),
        };
        let functions = functions.ok_or(technique::Error::NoTransferFunction)?;
        self.set_transfers(scene, &functions)?;
        let Some(plan) = plan else { return Ok(()) };
        let matter = Matter::of(scene, &functions);
        let mut parts = parts_of(&self.resident, self.shown, scene);
        parts.truncate(matter_count(scene));
        let (device, slices) = (&mut self.device, &mut self.slices);
        let transfer = self.transfer.get();
        self.light.of((matter, plan), |(_, plan)| {
            made_light(device, slices, scene, plan.clone(), &parts, transfer)
        })?;
        Ok(())
    }

    pub(super) fn set_transfers(
        &mut self,
        scene: &Scene,
        functions: &[&TransferFunction],
    ) -> Result<(), Error> {
        let Settings {
            color_space: space,
            preintegrated: is_preintegrated,
            ..
        } = *scene.settings;
        let key = Classifying {
            functions: functions.iter().copied().cloned().collect(),
            space,
            is_preintegrated,
            density: scene.settings.density_of_rays(),
            scatters: scene.settings.scatters(),
        };
        let (device, changes) = (&mut self.device, &mut self.changes);
        self.transfer.of(key, |_| {
            let absorbing = functions.iter().map(|&f| (f, scene.absorption(f)));
            let absorbing: Vec<_> = absorbing.collect();
            let gpu = device.gpu();
            let made = match functions[..] {
                [function] if is_preintegrated => {
                    let length = scene.length_of(function);
                    GpuTransfer::preintegrated(gpu, function, length, space)?
                }
                _ => GpuTransfer::absorbing(gpu, &absorbing, space)?,
            };
            // SAFETY: recorded outside rendering; `run` waits, and `made` lives meanwhile.
            device.run(|cmd| unsafe { made.record_upload(cmd) })?;
            *changes += 1;
            Ok::<_, Error>(made)
        })?;
        Ok(())
    }
}
