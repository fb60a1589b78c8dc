//! A renderer without its volume: what the next volume of a film can use again.

use super::Renderer;
use crate::gpu::{Headless, ParameterRing, Timer};
use crate::offscreen::{passes::Passes, targets::Targets};
use crate::volume::Volume;

/// A device, and the pipelines, targets and parameters that a renderer has made on it.
#[derive(Debug)]
pub struct Kit {
    targets: Option<Targets>,
    passes: Option<Passes>,
    ring: ParameterRing,
    timer: Option<Timer>,
    device: Headless,
}

impl Renderer<'_> {
    /// Gives the volume's device memory back and keeps the rest for [`Kit::renderer`].
    pub fn into_kit(self) -> Kit {
        Kit {
            targets: self.targets,
            passes: self.passes,
            ring: self.ring,
            timer: self.timer,
            device: self.device,
        }
    }
}

impl Kit {
    /// A renderer of `volume`. Nothing of it is uploaded yet.
    pub fn renderer(self, volume: &Volume) -> Renderer<'_> {
        Renderer {
            volume,
            resident: [const { None }; 4],
            transfer: None,
            targets: self.targets,
            passes: self.passes,
            ring: self.ring,
            timer: self.timer,
            device: self.device,
        }
    }
}
