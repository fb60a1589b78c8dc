//! Which voxels have a value, on the device: made only for a volume with holes, read by fetches only.

use super::volume::indices;
use crate::gpu::{
    Buffer, Error, Gpu, Image, ImageDesc, ImageKind, Region, Use, buffer_to_image, image_barrier,
};
use crate::volume::{Volume, VoxelBox};
use ash::vk;
use std::sync::Arc;

/// One byte a voxel, 1 = valid. Made empty; [`GpuMask::record_upload`] fills it.
#[derive(Debug)]
pub struct GpuMask {
    gpu: Arc<Gpu>,
    validity: Image,
}

impl GpuMask {
    /// The object for a volume like this one.
    ///
    /// # Errors
    /// Where the image is over a limit of the device, by the limit's name.
    pub fn new(gpu: &Arc<Gpu>, volume: &Volume) -> Result<Self, Error> {
        let desc = ImageDesc {
            kind: ImageKind::D3,
            extent: volume.dims,
            format: vk::Format::R8_UINT,
            usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
            name: "validity",
        };
        Ok(Self {
            gpu: Arc::clone(gpu),
            validity: Image::new(gpu, &desc)?,
        })
    }

    /// The mask, in [`Use::Sampled`] after an upload.
    pub fn validity(&self) -> &Image {
        &self.validity
    }

    /// Texels of `region`, as [`GpuMask::record_upload`] wants them in a staging buffer.
    pub fn staged(&self, validity: &[u8], volume: &Volume, region: VoxelBox) -> Vec<u8> {
        indices(volume, region).map(|i| validity[i]).collect()
    }

    /// Records the copy of `region` from the start of `staging`. `before` as in
    /// [`super::GpuVolume::record_upload`].
    ///
    /// # Errors
    /// A region outside the volume, a staging buffer that is too small.
    ///
    /// # Safety
    /// - `cmd` is recording, outside rendering; `self` and `staging` live until it has run;
    /// - `staging` holds [`GpuMask::staged`] of this region when `cmd` runs.
    pub unsafe fn record_upload(
        &self,
        cmd: vk::CommandBuffer,
        staging: &Buffer,
        region: VoxelBox,
        before: Use,
    ) -> Result<(), Error> {
        let part = Region {
            origin: region.min,
            extent: region.dims(),
        };
        // SAFETY: the caller's promises; the two barriers put the copy between earlier and later uses.
        unsafe {
            image_barrier(&self.gpu, cmd, &self.validity, before, Use::TransferWrite);
            buffer_to_image(&self.gpu, cmd, staging, 0, &self.validity, part)?;
            image_barrier(
                &self.gpu,
                cmd,
                &self.validity,
                Use::TransferWrite,
                Use::Sampled,
            );
        }
        Ok(())
    }
}
