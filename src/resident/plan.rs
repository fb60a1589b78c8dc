//! Into what a volume is put, and into how many bricks the limits of the device cut it.

use super::bricks::{Cell, cut};
use super::{TexelFormat, TextureLayout};
use crate::gpu::{Error, Gpu, ImageDesc, ImageKind};
use crate::volume::{Rescale, Volume, VoxelType};
use ash::vk;
use std::cell::OnceCell;

/// A plan is made of no more: 2^40.
const MOST_VOXELS: u128 = 1 << 40;

/// What a volume will take on a device, told before there is one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VolumePlan {
    /// Bytes of its textures, without what the driver pads them by.
    pub device_bytes: u64,
    /// Bytes of a buffer that brings all of it there at once.
    pub staging_bytes: u64,
    /// Into how many bricks the limits of the device cut it.
    pub bricks: usize,
}

impl VolumePlan {
    /// For a volume of so many voxels of a type; `has_holes`: some have no value.
    ///
    /// # Errors
    /// Where not even a voxel fits, as [`GpuVolume::new`](super::GpuVolume::new); no voxels, and more than a tebi,
    /// which nobody has and whose bricks would fill the memory.
    pub fn of(
        gpu: &Gpu,
        dims: [u32; 3],
        stored: VoxelType,
        has_holes: bool,
        layout: TextureLayout,
    ) -> Result<Self, Error> {
        let count: u128 = dims.iter().map(|&n| u128::from(n)).product();
        if count == 0 || count > MOST_VOXELS {
            return Err(Error::Argument {
                doing: format!("plan a volume of {dims:?} voxels"),
                wanted: format!("1 to {MOST_VOXELS} voxels"),
                found: count.to_string(),
            });
        }
        let plan = Plan {
            layout,
            texel: TexelFormat::choose(gpu, stored, Rescale::default()),
            has_holes,
        };
        let cells = Plan::cut(gpu, &[&plan], dims)?;
        let voxels = |dims: [u32; 3]| dims.iter().map(|&n| u64::from(n)).product::<u64>();
        let stored = cells.iter().map(|cell| voxels(cell.stored.dims()));
        let texel_bytes = plan.texel.bytes() as u64 + u64::from(has_holes);
        let device_bytes = texel_bytes * stored.sum::<u64>();
        Ok(Self {
            device_bytes,
            staging_bytes: device_bytes,
            bricks: cells.len(),
        })
    }
}

/// How a volume will lie in textures, before it is cut.
pub(super) struct Plan {
    pub layout: TextureLayout,
    pub texel: TexelFormat,
    pub has_holes: bool,
}

impl Plan {
    pub fn of(gpu: &Gpu, volume: &Volume, layout: TextureLayout) -> Self {
        Self {
            layout,
            texel: TexelFormat::choose(gpu, volume.voxels.voxel_type(), volume.rescale),
            has_holes: volume.validity.is_some(),
        }
    }

    pub fn values(&self, stored: [u32; 3]) -> ImageDesc<'static> {
        self.desc(stored, self.texel.format, "volume")
    }

    pub fn validity(&self, stored: [u32; 3]) -> ImageDesc<'static> {
        self.desc(stored, vk::Format::R8_UINT, "validity")
    }

    /// What stands in the place of a host's depth buffer.
    pub fn no_depth(&self) -> ImageDesc<'static> {
        ImageDesc {
            kind: ImageKind::D2,
            format: vk::Format::R8_UNORM,
            name: "no depth",
            ..self.validity([1; 3])
        }
    }

    fn desc(&self, stored: [u32; 3], format: vk::Format, name: &'static str) -> ImageDesc<'static> {
        ImageDesc {
            kind: self.layout.kind(),
            extent: self.layout.axes().map(|axis| stored[axis]),
            format,
            usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
            name,
        }
    }

    /// The limit that a brick of so many stored voxels is over.
    pub fn check(&self, gpu: &Gpu, stored: [u32; 3]) -> Result<(), Error> {
        gpu.check_image(&self.values(stored))?;
        if self.has_holes {
            gpu.check_image(&self.validity(stored))?;
        }
        Ok(())
    }

    /// Bricks in which all of them fit.
    pub fn cut(gpu: &Gpu, plans: &[&Self], dims: [u32; 3]) -> Result<Vec<Cell>, Error> {
        let halo = plans.first().map_or([0; 3], |plan| plan.layout.halo());
        let (too_large, trouble) = (OnceCell::new(), OnceCell::new());
        let fits = |stored| match plans.iter().try_for_each(|plan| plan.check(gpu, stored)) {
            Ok(()) => true,
            Err(limit @ Error::Limit { .. }) => {
                // The first is that of the whole volume.
                let _ = too_large.set(limit);
                false
            }
            // Smaller bricks do not help, and the device may well take larger ones.
            Err(other) => {
                let _ = trouble.set(other);
                true
            }
        };
        let cells = cut(dims, halo, fits);
        match trouble.into_inner() {
            Some(trouble) => Err(trouble),
            None => cells.ok_or_else(|| {
                let limit = too_large.into_inner();
                limit.expect("what cannot be cut to fit is over a limit")
            }),
        }
    }
}
