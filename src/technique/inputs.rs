//! What every technique reads, by the names that the shaders give it, and which variant of a shader that
//! asks for.

use super::{Filter, Lattice, Mode, Settings};
use crate::gpu::{Bindings, Error, Gpu, Layout, ParameterRing, Resource};
use crate::resident::{Brick, GpuTransfer, GpuVolume, TextureLayout};
use std::sync::Arc;

/// What a technique reads.
#[derive(Clone, Copy, Debug)]
pub struct Inputs<'a> {
    /// Parameters; one slot a recording.
    pub ring: &'a ParameterRing,
    /// What is shown.
    pub volume: &'a GpuVolume,
    /// The part of it that this recording shows.
    pub brick: &'a Brick,
    /// Classification; projecting modes do without.
    pub transfer: Option<&'a GpuTransfer>,
}

impl Inputs<'_> {
    /// A descriptor set of what `layout` declares, taken from the inputs and from `outputs`.
    ///
    /// # Errors
    /// Where a declared name is not there.
    pub fn bind(
        &self,
        gpu: &Arc<Gpu>,
        layout: &Layout,
        outputs: &[(&str, Resource)],
    ) -> Result<Bindings, Error> {
        let mut given = vec![("frame", Resource::Uniform(self.ring))];
        let values = match self.volume.layout() {
            TextureLayout::Texture3d => "volume",
            TextureLayout::Stack(_) => "stack",
        };
        given.push((values, Resource::sampled(&self.brick.values)));
        given.push(("volume_sampler", Resource::Sampler(self.volume.sampler())));
        if let Some(validity) = &self.brick.validity {
            given.push(("validity", Resource::sampled(validity)));
        }
        if let Some(transfer) = self.transfer {
            given.push(("transfer_table", Resource::sampled(transfer.table())));
            given.push(("points", Resource::Storage(transfer.points())));
        }
        given.extend_from_slice(outputs);
        given.retain(|(name, _)| layout.slots().iter().any(|slot| slot.name == *name));
        Bindings::new(gpu, layout, &given)
    }
}

/// The words that fill the slots of a shader's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Words {
    /// How values between voxels are made.
    pub filter: &'static str,
    /// Whether the volume has holes.
    pub holes: &'static str,
    /// Which samples a ray caster takes.
    pub lattice: &'static str,
    /// How values are classified.
    pub transfer: &'static str,
}

impl Words {
    /// The variant for a picture of such a volume.
    pub fn of(settings: &Settings, volume: &GpuVolume) -> Self {
        Self {
            filter: match settings.filter {
                Filter::Nearest => "nearest",
                Filter::Linear if settings.conformance || !volume.texel().is_filtered => {
                    "linear_fetch"
                }
                Filter::Linear => "linear",
            },
            holes: if volume.has_holes() { "mask" } else { "none" },
            lattice: match settings.lattice {
                Lattice::Ray => "ray",
                Lattice::Planes => "planes",
            },
            transfer: if settings.conformance {
                "points"
            } else {
                "table"
            },
        }
    }
}

/// The word of a compute pass's mode.
pub fn mode_word(mode: Mode) -> &'static str {
    match mode {
        Mode::Composite => "composite",
        Mode::Mip => "mip",
        Mode::Minip => "minip",
        Mode::Average | Mode::Xray => "sum",
    }
}
