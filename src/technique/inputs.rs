//! What every technique reads, by the names that the shaders give it, and which variant of a shader that
//! asks for.

use super::{Filter, Lattice, Mode, Settings};
use crate::gpu::{Bindings, Error, Gpu, Layout, ParameterRing, Resource};
use crate::resident::{GpuMask, GpuStack, GpuTransfer, GpuVolume, TexelFormat};
use std::sync::Arc;

/// Values on the device.
#[derive(Clone, Copy, Debug)]
pub enum GpuVoxels<'a> {
    /// For ray casting, projection and view-aligned slices.
    Volume(&'a GpuVolume),
    /// For 2D texture slicing.
    Stack(&'a GpuStack),
}

impl GpuVoxels<'_> {
    /// What the texels mean.
    pub fn texel(&self) -> &TexelFormat {
        match self {
            Self::Volume(volume) => volume.texel(),
            Self::Stack(stack) => stack.texel(),
        }
    }
}

/// What a technique reads.
#[derive(Clone, Copy, Debug)]
pub struct Inputs<'a> {
    /// Parameters; one slot a recording.
    pub ring: &'a ParameterRing,
    /// Values.
    pub voxels: GpuVoxels<'a>,
    /// Holes, if there are any.
    pub mask: Option<&'a GpuMask>,
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
        match self.voxels {
            GpuVoxels::Volume(volume) => {
                given.push(("volume", Resource::sampled(volume.values())));
                given.push(("volume_sampler", Resource::Sampler(volume.sampler())));
            }
            GpuVoxels::Stack(stack) => {
                given.push(("stack", Resource::sampled(stack.slices())));
                given.push(("volume_sampler", Resource::Sampler(stack.sampler())));
            }
        }
        if let Some(mask) = self.mask {
            given.push(("validity", Resource::sampled(mask.validity())));
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
    /// The variant for a picture of such voxels.
    pub fn of(settings: &Settings, texel: &TexelFormat, has_holes: bool) -> Self {
        Self {
            filter: match settings.filter {
                Filter::Nearest => "nearest",
                Filter::Linear if settings.conformance || !texel.is_filtered => "linear_fetch",
                Filter::Linear => "linear",
            },
            holes: if has_holes { "mask" } else { "none" },
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
