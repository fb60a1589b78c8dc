//! A volume on the device as a stack of 2D textures along one axis: the classic way, three copies of the data
//! for three axes.
//!
//! Layer s is slice s of axis k; axis (k + 1) mod 3 runs across, axis (k + 2) mod 3 down.

use super::TexelFormat;
use crate::gpu::{
    Buffer, Error, Gpu, Image, ImageDesc, ImageKind, Region, Sampler, Use, buffer_to_image,
    image_barrier,
};
use crate::volume::Volume;
use ash::vk;
use std::ops::Range;
use std::sync::Arc;

/// The slices of one axis. Made empty; [`GpuStack::record_upload`] fills it.
#[derive(Debug)]
pub struct GpuStack {
    gpu: Arc<Gpu>,
    axis: usize,
    texel: TexelFormat,
    slices: Image,
    sampler: Sampler,
}

impl GpuStack {
    /// Objects for the stack along `axis` of a volume like this one.
    ///
    /// # Errors
    /// Where the image is over a limit of the device (`maxImageArrayLayers` slices), by the limit's name.
    pub fn new(gpu: &Arc<Gpu>, volume: &Volume, axis: usize) -> Result<Self, Error> {
        let texel = TexelFormat::choose(gpu, volume.voxels.voxel_type(), volume.rescale);
        let desc = ImageDesc {
            kind: ImageKind::D2Array,
            extent: [1, 2, 3].map(|step| volume.dims[(axis + step) % 3]),
            format: texel.format,
            usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
            name: ["stack x", "stack y", "stack z"][axis],
        };
        Ok(Self {
            gpu: Arc::clone(gpu),
            axis,
            texel,
            slices: Image::new(gpu, &desc)?,
            sampler: Sampler::linear_clamp(gpu)?,
        })
    }

    /// The axis that the slices lie along.
    pub fn axis(&self) -> usize {
        self.axis
    }

    /// What its texels mean.
    pub fn texel(&self) -> &TexelFormat {
        &self.texel
    }

    /// The slices, in [`Use::Sampled`] after an upload.
    pub fn slices(&self) -> &Image {
        &self.slices
    }

    /// How a slice is read between texels.
    pub fn sampler(&self) -> &Sampler {
        &self.sampler
    }

    /// Texels of some slices, as [`GpuStack::record_upload`] wants them in a staging buffer.
    pub fn staged(&self, volume: &Volume, slices: Range<u32>) -> Vec<u8> {
        let [nx, ny, _] = volume.dims.map(|n| n as usize);
        let strides = [1, nx, nx * ny];
        let [across, down] = [1, 2].map(|step| (self.axis + step) % 3);
        let along =
            move |axis: usize| (0..volume.dims[axis] as usize).map(move |i| i * strides[axis]);
        let indices = slices.clone().flat_map(|slice| {
            let start = slice as usize * strides[self.axis];
            along(down).flat_map(move |v| along(across).map(move |u| start + v + u))
        });
        let mut bytes = Vec::with_capacity(self.staging_bytes(&slices) as usize);
        self.texel.encode(&volume.voxels, indices, &mut bytes);
        bytes
    }

    /// Size of [`GpuStack::staged`].
    pub fn staging_bytes(&self, slices: &Range<u32>) -> u64 {
        let [width, height, _] = self.slices.extent().map(u64::from);
        width * height * u64::from(slices.end - slices.start) * self.texel.bytes() as u64
    }

    /// Records the copy of some slices from the start of `staging`. `before` as in
    /// [`super::GpuVolume::record_upload`].
    ///
    /// # Errors
    /// Slices that are not there, a staging buffer that is too small.
    ///
    /// # Safety
    /// - `cmd` is recording, outside rendering; `self` and `staging` live until it has run;
    /// - `staging` holds [`GpuStack::staged`] of these slices when `cmd` runs.
    pub unsafe fn record_upload(
        &self,
        cmd: vk::CommandBuffer,
        staging: &Buffer,
        slices: Range<u32>,
        before: Use,
    ) -> Result<(), Error> {
        let [width, height, _] = self.slices.extent();
        let region = Region {
            origin: [0, 0, slices.start],
            extent: [width, height, slices.end.saturating_sub(slices.start)],
        };
        // SAFETY: the caller's promises; the two barriers put the copy between earlier and later uses.
        unsafe {
            image_barrier(&self.gpu, cmd, &self.slices, before, Use::TransferWrite);
            buffer_to_image(&self.gpu, cmd, staging, 0, &self.slices, region)?;
            image_barrier(
                &self.gpu,
                cmd,
                &self.slices,
                Use::TransferWrite,
                Use::Sampled,
            );
        }
        Ok(())
    }
}
