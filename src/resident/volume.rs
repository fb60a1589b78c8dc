//! A volume on the device as a 3D texture.

use super::TexelFormat;
use crate::gpu::{
    Buffer, Error, Gpu, Image, ImageDesc, ImageKind, Region, Sampler, Use, buffer_to_image,
    image_barrier,
};
use crate::volume::{Grid, Volume, VoxelBox};
use ash::vk;
use std::sync::Arc;

/// A volume as one brick. Made empty; [`GpuVolume::record_upload`] fills it.
#[derive(Debug)]
pub struct GpuVolume {
    gpu: Arc<Gpu>,
    grid: Grid,
    texel: TexelFormat,
    values: Image,
    sampler: Sampler,
}

impl GpuVolume {
    /// Objects for a volume like this one.
    ///
    /// # Errors
    /// Where an image is over a limit of the device, by the limit's name.
    pub fn new(gpu: &Arc<Gpu>, volume: &Volume) -> Result<Self, Error> {
        let texel = TexelFormat::choose(gpu, volume.voxels.voxel_type(), volume.rescale);
        let desc = ImageDesc {
            kind: ImageKind::D3,
            extent: volume.dims,
            format: texel.format,
            usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
            name: "volume",
        };
        Ok(Self {
            gpu: Arc::clone(gpu),
            grid: volume.grid(),
            texel,
            values: Image::new(gpu, &desc)?,
            sampler: Sampler::linear_clamp(gpu)?,
        })
    }

    /// Where the voxels lie.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// What its texels mean.
    pub fn texel(&self) -> &TexelFormat {
        &self.texel
    }

    /// The values, in [`Use::Sampled`] after an upload.
    pub fn values(&self) -> &Image {
        &self.values
    }

    /// How it is read between texels.
    pub fn sampler(&self) -> &Sampler {
        &self.sampler
    }

    /// Texels of `region`, as [`GpuVolume::record_upload`] wants them in a staging buffer.
    pub fn staged(&self, volume: &Volume, region: VoxelBox) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(self.staging_bytes(region) as usize);
        self.texel
            .encode(&volume.voxels, indices(volume, region), &mut bytes);
        bytes
    }

    /// Size of [`GpuVolume::staged`].
    pub fn staging_bytes(&self, region: VoxelBox) -> u64 {
        let voxels: u64 = region.dims().iter().map(|&n| u64::from(n)).product();
        voxels * self.texel.bytes() as u64
    }

    /// Records the copy of `region` from the start of `staging`. `before` is what was last done with the
    /// volume: [`Use::Nothing`] before the first upload of all, [`Use::Sampled`] to replace a part.
    ///
    /// # Errors
    /// A region outside the volume, a staging buffer that is too small.
    ///
    /// # Safety
    /// - `cmd` is recording, outside rendering; `self` and `staging` live until it has run;
    /// - `staging` holds [`GpuVolume::staged`] of this region when `cmd` runs.
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
            image_barrier(&self.gpu, cmd, &self.values, before, Use::TransferWrite);
            buffer_to_image(&self.gpu, cmd, staging, 0, &self.values, part)?;
            image_barrier(
                &self.gpu,
                cmd,
                &self.values,
                Use::TransferWrite,
                Use::Sampled,
            );
        }
        Ok(())
    }
}

/// Indices of the voxels of a region, x fastest.
pub(super) fn indices(volume: &Volume, region: VoxelBox) -> impl Iterator<Item = usize> {
    let [nx, ny, _] = volume.dims.map(|n| n as usize);
    let [x, y, z] = [0, 1, 2].map(|k| region.min[k] as usize..region.max[k] as usize);
    z.flat_map(move |z| {
        let x = x.clone();
        y.clone()
            .flat_map(move |y| x.clone().map(move |x| (z * ny + y) * nx + x))
    })
}
