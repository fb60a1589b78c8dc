//! The pattern of jittered rays ([`crate::blue_noise`]) as a texture of one number a texel.

use crate::blue_noise::BLUE_NOISE;
use crate::gpu::{
    Buffer, Error, Gpu, Image, ImageDesc, ImageKind, Memory, Region, Use, buffer_to_image,
    image_barrier,
};
use crate::shaders::BLUE_NOISE_SIDE;
use ash::vk;
use std::sync::Arc;

/// The texture and what fills it.
#[derive(Debug)]
pub struct BlueNoiseTexture {
    image: Image,
    staging: Buffer,
}

impl BlueNoiseTexture {
    /// Empty until [`BlueNoiseTexture::record_upload`].
    ///
    /// # Errors
    /// Where the device gives no memory.
    pub fn new(gpu: &Arc<Gpu>) -> Result<Self, Error> {
        let desc = ImageDesc {
            kind: ImageKind::D2,
            extent: [BLUE_NOISE_SIDE, BLUE_NOISE_SIDE, 1],
            format: vk::Format::R16_UINT,
            usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
            name: "blue noise",
        };
        let bytes = BLUE_NOISE.len() as u64;
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        let staging = Buffer::new(gpu, bytes, usage, Memory::Upload, "blue noise staging")?;
        staging.write(0, BLUE_NOISE)?;
        Ok(Self {
            image: Image::new(gpu, &desc)?,
            staging,
        })
    }

    /// The texture, in [`Use::Sampled`] after the upload.
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// Records the copy that fills the texture.
    ///
    /// # Errors
    /// None but a mistake of ours.
    ///
    /// # Safety
    /// `cmd` is recording, outside rendering, and this is the first upload; `self` lives until it has run.
    pub unsafe fn record_upload(&self, gpu: &Gpu, cmd: vk::CommandBuffer) -> Result<(), Error> {
        let (image, region) = (&self.image, Region::whole(&self.image));
        // SAFETY: the caller's promises; the texture is new and the staging buffer is full.
        unsafe {
            image_barrier(gpu, cmd, image, Use::Nothing, Use::TransferWrite);
            buffer_to_image(gpu, cmd, &self.staging, 0, image, region)?;
            image_barrier(gpu, cmd, image, Use::TransferWrite, Use::Sampled);
        }
        Ok(())
    }
}
