//! The images that a picture is made in, and the way back to the CPU.

use crate::gpu::{
    Buffer, Error, Gpu, Headless, Image, Memory, Region, Use, image_barrier, image_to_buffer,
};
use crate::technique::slices_3d::half_angle::light_buffer;
use crate::technique::{PatchRoom, Patches, RayTiles, accumulation};
use ash::vk;
use std::sync::Arc;

/// A submission copies no more.
const COPIED_BYTES: u64 = 64 << 20;

/// Images of one extent.
#[derive(Debug)]
pub struct Targets {
    /// Pixels across and down.
    pub extent: [u32; 2],
    /// What a technique leaves.
    pub accumulation: Image,
    /// What the ray caster leaves beside it; counts of slicers.
    pub layers: Image,
    /// Resolved colour of what projects.
    pub picture: Image,
    /// Which tiles rays draw.
    pub tiles: RayTiles,
    /// What the light sees of half-angle slices, once they were wanted.
    light_buffer: Option<Image>,
    /// Which parts of slices are drawn, once that was wanted.
    patches: Option<(Patches, PatchRoom)>,
    readback: Buffer,
}

impl Targets {
    /// Objects for pictures of `extent`.
    pub fn new(gpu: &Arc<Gpu>, extent: [u32; 2]) -> Result<Self, Error> {
        let bytes = u64::from(extent[0]) * u64::from(extent[1]) * 16;
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        Ok(Self {
            extent,
            accumulation: accumulation(gpu, extent, "accumulation")?,
            layers: accumulation(gpu, extent, "layers")?,
            picture: accumulation(gpu, extent, "picture")?,
            tiles: RayTiles::new(gpu, extent)?,
            light_buffer: None,
            patches: None,
            readback: Buffer::new(gpu, bytes, usage, Memory::Readback, "readback")?,
        })
    }

    /// Makes the image that the light sees, where it is not there yet.
    pub fn prepare_light_buffer(&mut self, gpu: &Arc<Gpu>, extent: [u32; 2]) -> Result<(), Error> {
        let [width, height] = extent;
        let found = self.light_buffer.as_ref().map(Image::extent);
        if found != Some([width, height, 1]) {
            self.light_buffer = Some(light_buffer(gpu, extent)?);
        }
        Ok(())
    }

    /// The image that the light sees.
    pub fn light_buffer(&self) -> &Image {
        let made = self.light_buffer.as_ref();
        made.expect("`prepare_light_buffer` comes before a picture with half-angle slices")
    }

    /// Makes the lists of patches, where there are none that are long enough.
    pub fn prepare_patches(&mut self, gpu: &Arc<Gpu>, room: PatchRoom) -> Result<(), Error> {
        let made = match self.patches.take() {
            Some((made, _)) if made.holds(room) => made,
            _ => Patches::new(gpu, room)?,
        };
        self.patches = Some((made, room));
        Ok(())
    }

    /// The lists of patches, and how large those of this picture get.
    pub fn patches(&self) -> (&Patches, PatchRoom) {
        let (made, room) = self
            .patches
            .as_ref()
            .expect("`prepare_patches` comes before a picture of patches");
        (made, *room)
    }

    /// The pixels of one of the images, rows from the top. `used` is what was last done with it, and can be done again.
    pub fn read(
        &self,
        device: &mut Headless,
        image: &Image,
        used: Use,
    ) -> Result<Vec<[f32; 4]>, Error> {
        let gpu = Arc::clone(device.gpu());
        let [width, height] = self.extent;
        let rows = (COPIED_BYTES / (16 * u64::from(width))).clamp(1, height.into()) as u32;
        for first in (0..height).step_by(rows as usize) {
            let region = Region {
                origin: [0, first, 0],
                extent: [width, rows.min(height - first), 1],
            };
            let offset = 16 * u64::from(width) * u64::from(first);
            // SAFETY: recorded outside rendering; `run` waits, and `self` lives meanwhile.
            device.run(|cmd| unsafe {
                image_barrier(&gpu, cmd, image, used, Use::TransferRead);
                image_to_buffer(&gpu, cmd, image, region, &self.readback, offset)?;
                image_barrier(&gpu, cmd, image, Use::TransferRead, used);
                Ok(())
            })?;
        }
        let count = self.extent.map(|n| n as usize).iter().product();
        let mut pixels = vec![[0.0; 4]; count];
        self.readback
            .read(0, bytemuck::cast_slice_mut(&mut pixels))?;
        Ok(pixels)
    }
}
