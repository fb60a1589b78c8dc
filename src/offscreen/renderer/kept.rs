//! What outlives a volume: the device, and what pictures of the next volume are drawn with too.

use super::Renderer;
use crate::gpu::{Headless, ParameterRing, Timer};
use crate::offscreen::keyed::Keyed;
use crate::offscreen::passes::Passes;
use crate::offscreen::targets::Targets;
use crate::offscreen::time_slices::TimeSlices;
use crate::offscreen::{
    Error,
    renderer::{Ends, PathSky, Preclassified, Skipped},
};
use crate::technique::parameter_ring;
use crate::volume::Volume;
use std::collections::HashMap;

/// A device between two volumes, with the pipelines and images of the last picture.
#[derive(Debug)]
pub struct Kept {
    tools: Option<Tools>,
    /// The device.
    pub device: Headless,
}

/// What one picture was made with, and the next one of its kind and extent is made with again.
#[derive(Debug)]
pub(super) struct Tools {
    pub(super) targets: Option<Targets>,
    pub(super) passes: Option<Passes>,
    pub(super) ring: ParameterRing,
    pub(super) timer: Option<Timer>,
}

impl From<Headless> for Kept {
    fn from(device: Headless) -> Self {
        Self {
            tools: None,
            device,
        }
    }
}

impl<'v> Renderer<'v> {
    /// A renderer of the [`Scene::volumes`](crate::scene::Scene::volumes) of scenes, with what another renderer left.
    ///
    /// # Errors
    /// Where the device gives no memory.
    pub fn with_kept(kept: Kept, volumes: Vec<&'v Volume>) -> Result<Self, Error> {
        let Kept { tools, device } = kept;
        let gpu = device.gpu();
        let slices = TimeSlices::of(gpu);
        let Tools {
            targets,
            passes,
            ring,
            timer,
        } = match tools {
            Some(tools) => tools,
            None => Tools {
                targets: None,
                passes: None,
                ring: parameter_ring(gpu, 1)?,
                timer: Timer::new(gpu)?,
            },
        };
        Ok(Self {
            volumes,
            shown: 0,
            streaming: None,
            preclassified: Preclassified::default(),
            resident: HashMap::new(),
            transfer: Keyed::default(),
            light: Keyed::default(),
            skipped: Skipped::default(),
            targets,
            passes,
            ring,
            timer,
            slices,
            known: None,
            changes: 0,
            passes_done: [0, 1],
            behind: None,
            field: Keyed::default(),
            path_ends: Ends::default(),
            path_sky: PathSky::default(),
            device,
        })
    }

    /// The device, free for another volume, with the pipelines and images of the last picture.
    pub fn into_kept(self) -> Kept {
        let Self {
            targets,
            passes,
            ring,
            timer,
            mut device,
            resident,
            preclassified,
            transfer,
            light,
            skipped,
            streaming,
            ..
        } = self;
        drop((resident, preclassified, transfer, light, skipped, streaming));
        // The next volume finds the memory of this one free.
        device.tidy();
        let tools = Tools {
            targets,
            passes,
            ring,
            timer,
        };
        Kept {
            tools: Some(tools),
            device,
        }
    }
}
