//! Voxels that are classified before they are interpolated: what a function makes of them, made anew only where that changes.
//!
//! ```text
//! codes      stay on the device, which makes runs of them: a new function brings what each code is made of
//! volumes    four of floats, for all else: made where a picture reads them
//! ```

use super::Renderer;
use super::copied::Copied;
use crate::gpu::Headless;
use crate::offscreen::keyed::Keyed;
use crate::offscreen::stream::if_it_fits;
use crate::offscreen::{Error, renderer::Skipped};
use crate::resident::{ClassifiedRuns, PayloadFloats, RunBuilder};
use crate::scene::Scene;
use crate::technique;
use crate::technique::preclassified::Law;
use crate::volume::{Rescale, Volume, Voxels};
use std::borrow::Cow;

/// Which of the four volumes of classified voxels is their depth.
pub(super) const DEPTH: usize = 3;

/// What one function makes of the voxels.
#[derive(Debug, Default)]
pub struct Preclassified {
    law: Option<Law>,
    volumes: Option<Box<[Volume; 4]>>,
    codes: Codes,
}

/// The codes of the voxels on the device.
#[derive(Debug, Default)]
enum Codes {
    #[default]
    NotAsked,
    /// The voxels have none, or there is no room.
    None,
    There(Box<RunBuilder>),
}

impl Preclassified {
    /// The volumes that pictures read: those that were given, or those that are made of the first, where they have been made.
    pub fn read<'a>(&'a self, copied: Copied, given: &[&'a Volume]) -> Vec<&'a Volume> {
        match (&self.volumes, copied.is_preclassified) {
            (Some(made), true) => made.iter().collect(),
            _ => given.to_vec(),
        }
    }

    /// The voxels of volume number `number` of those that pictures of `scene` read.
    ///
    /// # Panics
    /// Where no picture of the scene was uploaded.
    pub fn voxels<'a>(
        &'a self,
        scene: &Scene,
        given: &[&'a Volume],
        number: usize,
    ) -> Cow<'a, Volume> {
        let copied = Copied::of(scene);
        match &self.volumes {
            None if copied.is_preclassified => {
                let law = self.law.as_ref().expect("uploaded");
                Cow::Owned(of_codes(given[0], law, number))
            }
            _ => Cow::Borrowed(self.read(copied, given)[number]),
        }
    }

    /// Runs that the device makes of codes, and outlines of the four volumes; `None` where there are no codes, or no room, or
    /// where such floats do not hold what voxels are made of.
    ///
    /// # Errors
    /// Where the device is lost.
    ///
    /// # Panics
    /// Where there is no law.
    pub fn runs(
        &mut self,
        device: &mut Headless,
        volume: &Volume,
        floats: PayloadFloats,
    ) -> Result<Option<(ClassifiedRuns, [Volume; 4])>, Error> {
        if let Codes::NotAsked = self.codes {
            let made = if_it_fits(RunBuilder::new(device, volume))?.flatten();
            self.codes = made.map_or(Codes::None, |made| Codes::There(Box::new(made)));
        }
        let law = self.law.as_ref().expect("a law");
        let (Codes::There(builder), Some(materials)) = (&self.codes, law.materials(volume)) else {
            return Ok(None);
        };
        let made = if_it_fits(builder.build(device, &materials, floats))?.flatten();
        let outlines = builder
            .ranges(&materials)
            .map(|range| outline(volume, range));
        Ok(made.map(|made| (made, outlines)))
    }
}

impl Renderer<'_> {
    /// Forgets what another function has made of the voxels.
    ///
    /// # Errors
    /// Where no function says what voxels are made of.
    pub(super) fn heed_law(&mut self, scene: &Scene) -> Result<(), technique::Error> {
        let there = &mut self.preclassified;
        let law = scene.law()?;
        if law.is_some() && law != there.law {
            (there.law, there.volumes) = (law, None);
            self.resident.retain(|copied, _| !copied.is_preclassified);
            self.skipped = Skipped::default();
            self.light = Keyed::default();
        }
        Ok(())
    }

    /// Makes the four volumes, where pictures read such.
    ///
    /// # Errors
    /// Where the numbers make no volumes.
    pub(super) fn make_volumes(&mut self, copied: Copied) -> Result<(), technique::Error> {
        let there = &mut self.preclassified;
        if let (Some(law), None, true) = (&there.law, &there.volumes, copied.is_preclassified) {
            there.volumes = Some(Box::new(law.volumes(self.volumes[0])?));
        }
        Ok(())
    }
}

/// All but the voxels of one of the four volumes.
fn outline(volume: &Volume, value_range: [f64; 2]) -> Volume {
    Volume {
        voxels: Voxels::F32(Vec::new()),
        validity: volume.validity.clone(),
        rescale: Rescale::default(),
        hounsfield: false,
        unit: None,
        value_range,
        ..*volume
    }
}

/// One of the four volumes, of voxels that have codes.
fn of_codes(volume: &Volume, law: &Law, number: usize) -> Volume {
    let materials = law.materials(volume);
    let (codes, materials) = volume.voxels.codes().zip(materials).expect("codes");
    let numbers: Vec<f32> = materials.iter().map(|material| material[number]).collect();
    Volume {
        voxels: Voxels::F32(codes.look_up(&numbers)),
        ..outline(volume, [0.0; 2])
    }
}
