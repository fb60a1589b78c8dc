//! The images that a picture is made in, and the way back to the CPU.

use super::passes::Passes;
use crate::gpu::{
    Buffer, Error, Gpu, Headless, Image, Memory, Region, Use, image_barrier, image_to_buffer,
};
use crate::technique::accumulation;
use crate::technique::gather::{Canvas, CanvasDesc};
use ash::vk;
use std::sync::Arc;

/// A submission copies no more.
const COPIED_BYTES: u64 = 64 << 20;

/// Images of one extent, for the passes of one kind of picture.
#[derive(Debug)]
pub struct Targets {
    /// What the technique fills.
    pub canvas: Canvas,
    /// Whether what rays leave beside the picture is kept.
    keeps_layers: bool,
    /// Voxels of what is shown.
    dims: [u32; 3],
    intermediate_room: [u32; 2],
    /// Where a slicer counts samples, once that was wanted.
    pub count: Option<Canvas>,
    /// Where it becomes a picture.
    pub output: Output,
}

/// From what was gathered to the CPU.
#[derive(Debug)]
pub struct Output {
    /// Pixels across and down.
    pub extent: [u32; 2],
    /// The colours of what projects.
    pub resolved: Option<Image>,
    /// Four f32 a pixel, rows from the top.
    pub readback: Buffer,
}

impl Targets {
    /// Objects for pictures of such a canvas.
    pub fn new(gpu: &Arc<Gpu>, passes: &Passes, desc: &CanvasDesc) -> Result<Self, Error> {
        let bytes = u64::from(desc.extent[0]) * u64::from(desc.extent[1]) * 16;
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let resolved = passes.has_resolve();
        let resolved = resolved.then(|| accumulation(gpu, desc.extent, "picture"));
        Ok(Self {
            canvas: passes.picture().canvas(desc)?,
            keeps_layers: desc.keeps_layers,
            dims: desc.dims,
            intermediate_room: desc.intermediate_room,
            count: None,
            output: Output {
                extent: desc.extent,
                resolved: resolved.transpose()?,
                readback: Buffer::new(gpu, bytes, usage, Memory::Readback, "readback")?,
            },
        })
    }

    /// Whether they serve pictures of another canvas that the same passes fill.
    pub fn serve(&self, desc: &CanvasDesc) -> bool {
        let has_layers = self.keeps_layers || !desc.keeps_layers;
        let is_as_large = self.extent() == desc.extent
            && (0..2).all(|k| self.intermediate_room[k] >= desc.intermediate_room[k]);
        is_as_large && self.dims == desc.dims && has_layers
    }

    /// Pixels across and down.
    pub fn extent(&self) -> [u32; 2] {
        self.canvas.extent()
    }

    /// Where the samples of a slicer are counted by `passes`, of the same patches as those of the picture.
    pub fn prepare_count(&mut self, gpu: &Arc<Gpu>, passes: &Passes) -> Result<(), Error> {
        let made = match self.count.take() {
            Some(made) => made,
            None => passes.count(gpu)?.canvas(&CanvasDesc {
                extent: self.extent(),
                dims: self.dims,
                intermediate_room: self.intermediate_room,
                keeps_layers: false,
                beside: None,
            })?,
        };
        self.count.insert(made).patches = self.canvas.patches.clone();
        Ok(())
    }

    /// The pixels of one of the images, rows from the top. `used` is what was last done with it, and can be done again.
    pub fn read(
        &self,
        device: &mut Headless,
        image: &Image,
        used: Use,
    ) -> Result<Vec<[f32; 4]>, Error> {
        self.read_layer(device, image, 0, used)
    }

    /// The same of one image of an array.
    pub fn read_layer(
        &self,
        device: &mut Headless,
        image: &Image,
        number: u32,
        used: Use,
    ) -> Result<Vec<[f32; 4]>, Error> {
        let gpu = Arc::clone(device.gpu());
        let [width, height] = self.extent();
        let rows = (COPIED_BYTES / (16 * u64::from(width))).clamp(1, height.into()) as u32;
        for first in (0..height).step_by(rows as usize) {
            let region = Region {
                origin: [0, first, number],
                extent: [width, rows.min(height - first), 1],
            };
            let offset = 16 * u64::from(width) * u64::from(first);
            // SAFETY: recorded outside rendering; `run` waits, and `self` lives meanwhile.
            device.run(|cmd| unsafe {
                image_barrier(&gpu, cmd, image, used, Use::TransferRead);
                image_to_buffer(&gpu, cmd, image, region, &self.output.readback, offset)?;
                image_barrier(&gpu, cmd, image, Use::TransferRead, used);
                Ok(())
            })?;
        }
        self.output.pixels()
    }
}

impl Output {
    /// Whether a copy of all of it is no long work.
    pub fn is_small(&self) -> bool {
        self.readback.bytes() <= COPIED_BYTES
    }

    /// What was copied last.
    pub fn pixels(&self) -> Result<Vec<[f32; 4]>, Error> {
        let mut pixels = vec![[0.0; 4]; self.readback.bytes() as usize / 16];
        self.readback
            .read(0, bytemuck::cast_slice_mut(&mut pixels))?;
        Ok(pixels)
    }
}
