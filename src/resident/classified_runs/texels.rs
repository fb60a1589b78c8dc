//! Images whose texels are a sequence, in rows of so many.

use crate::gpu::{
    Buffer, Error, Gpu, Headless, Image, ImageDesc, ImageKind, Memory, Region, Use,
    buffer_to_image, image_barrier, image_to_buffer,
};
use ash::vk;
use std::sync::Arc;

/// Texels of a row (`shaders/lib/channels_on_runs.wgsl`).
pub const WIDTH: u32 = 4096;
/// Rows that are staged at once.
const STAGED_ROWS: u32 = 64;

/// So many texels in rows.
#[derive(Clone, Copy)]
pub struct Texels {
    pub format: vk::Format,
    pub count: u64,
    pub name: &'static str,
}

pub fn bytes_of(image: &Image) -> u64 {
    bytes_in(image.format(), Region::whole(image))
}

pub fn bytes_in(format: vk::Format, part: Region) -> u64 {
    part.bytes(format).expect("a format of ours")
}

/// What an image holds. It is in [`Use::Sampled`] before and after.
pub fn read_back(device: &mut Headless, image: &Image) -> Result<Vec<u8>, Error> {
    let gpu = Arc::clone(device.gpu());
    let bytes = bytes_of(image);
    let to = vk::BufferUsageFlags::TRANSFER_DST;
    let read = Buffer::new(&gpu, bytes, to, Memory::Readback, "runs that are read")?;
    device.run(|cmd| {
        // SAFETY: recorded outside rendering; both live until `run` has waited, and nothing else uses the buffer.
        unsafe {
            image_barrier(&gpu, cmd, image, Use::Sampled, Use::TransferRead);
            image_to_buffer(&gpu, cmd, image, Region::whole(image), &read, 0)?;
            image_barrier(&gpu, cmd, image, Use::TransferRead, Use::Sampled);
            crate::gpu::buffer_barrier(&gpu, cmd, &read, Use::TransferWrite, Use::HostRead);
        }
        Ok(())
    })?;
    let mut out = vec![0; bytes as usize];
    read.read(0, &mut out)?;
    Ok(out)
}

impl Texels {
    /// How many there are in the image: whole rows, where there is more than one, and one texel where there are none.
    pub fn extent(self) -> [u32; 3] {
        let count = self.count.max(1);
        let height = count.div_ceil(WIDTH.into());
        [
            count.min(WIDTH.into()) as u32,
            height.try_into().unwrap_or(u32::MAX),
            1,
        ]
    }

    /// Their image, in [`Use::Nothing`].
    pub fn empty(self, gpu: &Arc<Gpu>) -> Result<Image, Error> {
        let usage = vk::ImageUsageFlags::SAMPLED
            | vk::ImageUsageFlags::TRANSFER_DST
            | vk::ImageUsageFlags::TRANSFER_SRC;
        let desc = ImageDesc {
            kind: ImageKind::D2,
            extent: self.extent(),
            format: self.format,
            usage,
            name: self.name,
        };
        Image::new(gpu, &desc)
    }

    /// The rows of the image in parts of `rows`.
    pub fn parts(self, rows: u32) -> impl Iterator<Item = Region> {
        let [width, height, _] = self.extent();
        let first = (0..height).step_by(rows as usize);
        first.map(move |first| Region {
            origin: [0, first, 0],
            extent: [width, rows.min(height - first), 1],
        })
    }

    /// Their image, filled by the host. `write` puts the next texels into their places, part after part; behind the last of
    /// them all bytes are 0.
    pub fn image(
        self,
        device: &mut Headless,
        mut write: impl FnMut(&mut [u8]),
    ) -> Result<Image, Error> {
        let gpu = Arc::clone(device.gpu());
        let image = self.empty(&gpu)?;
        let bytes = |part| bytes_in(self.format, part);
        let largest = self.parts(STAGED_ROWS).next().map_or(0, bytes);
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        let staging = Buffer::new(&gpu, largest, usage, Memory::Upload, "staged runs")?;
        for part in self.parts(STAGED_ROWS) {
            staging.write_with(0, bytes(part), &mut write)?;
            device.run(|cmd| {
                // SAFETY: recorded outside rendering; both live until `run` has waited, and nothing else knows the image yet; the host
                // has written these rows before.
                unsafe { self.copy_rows(&gpu, cmd, &staging, &image, part) }
            })?;
        }
        Ok(image)
    }

    /// Records that rows of the image become what the beginning of `staging` holds, all rows before them being there.
    ///
    /// # Safety
    /// `cmd` is recording outside rendering; both live until it has run; what `staging` holds is visible to transfers.
    pub unsafe fn copy_rows(
        self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        staging: &Buffer,
        image: &Image,
        rows: Region,
    ) -> Result<(), Error> {
        let before = match rows.origin[1] {
            0 => Use::Nothing,
            _ => Use::Sampled,
        };
        // SAFETY: the caller's promises; the image is known nowhere else while it is being made.
        unsafe {
            image_barrier(gpu, cmd, image, before, Use::TransferWrite);
            buffer_to_image(gpu, cmd, staging, 0, image, rows)?;
            image_barrier(gpu, cmd, image, Use::TransferWrite, Use::Sampled);
        }
        Ok(())
    }
}
