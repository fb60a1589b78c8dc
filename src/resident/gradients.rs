//! Gradients at the voxels, made on the device and kept there.
//!
//! Interpolating kept central differences is what central differences of the trilinear field are (`sampling.md` 7),
//! by one look-up of four half floats in place of six of a value: memory for time. They are kept as parts of the range
//! of values, along the grid axes, so that no volume's unit leaves what half floats hold; halves are off by 2^-11 of
//! a gradient, and by 2^-25 of the range where it is under 2^-14 of it.

use super::GpuVolume;
use crate::gpu::{
    Bindings, ComputePipeline, Error, Gpu, Image, ImageDesc, ParameterRing, Resource, Use,
    group_count, image_barrier, within,
};
use crate::resident::TextureLayout;
use crate::shaders::{Frame, GRADIENT_LINEAR, GRADIENT_SOBEL, shader};
use ash::vk;
use bytemuck::Zeroable;
use std::ops::Range;
use std::sync::Arc;

/// What is kept at the voxels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum KeptOperator {
    /// Central differences.
    Differences,
    /// Sobel's operator.
    Sobel,
}

/// The gradients of a volume. Their textures are made empty; [`KeptGradients::record`] fills them.
#[derive(Debug)]
pub struct KeptGradients {
    gpu: Arc<Gpu>,
    operator: KeptOperator,
    scale: f32,
    images: Vec<Image>,
    extents: Vec<[u32; 3]>,
    pipeline: ComputePipeline,
    ring: ParameterRing,
    bindings: Vec<Bindings>,
}

const FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

impl KeptGradients {
    /// Bytes of one voxel.
    pub const BYTES_PER_VOXEL: u64 = 8;

    /// Objects for the gradients of a volume of voxels, or of one with voxels as its
    /// [`gradient_source`](GpuVolume::gradient_source).
    ///
    /// # Errors
    /// Where a texture is over a limit of the device, or it gives no memory.
    pub fn new(gpu: &Arc<Gpu>, volume: &GpuVolume, operator: KeptOperator) -> Result<Self, Error> {
        let source = volume.gradient_source().unwrap_or(volume);
        let layout = volume.layout();
        let (word, values) = match layout {
            TextureLayout::Texture3d => ("box", "volume"),
            TextureLayout::Stack(_) => ("stack", "stack"),
        };
        let pipeline = ComputePipeline::new(gpu, shader(&format!("precompute_gradients.{word}")))?;
        let [low, high] = volume.value_range();
        let range = (high - low) as f32;
        let scale = if range > 0.0 && range.is_finite() {
            range
        } else {
            1.0
        };
        let count = source.bricks().len() as u32;
        let ring = ParameterRing::new(gpu, size_of::<Frame>() as u32, count, "kept gradients")?;
        let (mut images, mut extents, mut bindings) = (Vec::new(), Vec::new(), Vec::new());
        for (slot, brick) in (0..).zip(source.bricks()) {
            let stored = brick.cell.stored.dims();
            let image = Image::new(gpu, &Self::desc(layout, stored))?;
            let given = [
                ("frame", Resource::Uniform(&ring)),
                (values, Resource::sampled(&brick.values)),
                ("gradient_source", Resource::sampled(&brick.values)),
                ("kept", Resource::written(&image)),
            ];
            bindings.push(Bindings::new(gpu, pipeline.layout(), &given)?);
            let coding = source.texel().coding;
            let mut frame = Frame::zeroed();
            frame.dims = source.grid().dims.map(|n| n as f32);
            frame.brick_origin = brick.cell.stored.min.map(|n| n as f32);
            frame.brick_dims = stored.map(|n| n as f32);
            if let TextureLayout::Stack(axis) = layout {
                frame.slice_axis = axis as u32;
            }
            frame.slope = coding.slope / scale;
            frame.gradient_scale = coding.scale;
            frame.gradient_codes_are_integers = coding.is_integer.into();
            frame.gradient_operator = match operator {
                KeptOperator::Differences => GRADIENT_LINEAR,
                KeptOperator::Sobel => GRADIENT_SOBEL,
            };
            ring.write(slot, bytemuck::bytes_of(&frame))?;
            images.push(image);
            extents.push(stored);
        }
        Ok(Self {
            gpu: Arc::clone(gpu),
            operator,
            scale,
            images,
            extents,
            pipeline,
            ring,
            bindings,
        })
    }

    fn desc(layout: TextureLayout, stored: [u32; 3]) -> ImageDesc<'static> {
        ImageDesc {
            kind: layout.kind(),
            extent: layout.axes().map(|axis| stored[axis]),
            format: FORMAT,
            usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::STORAGE,
            name: "kept gradients",
        }
    }

    /// What they are.
    pub fn operator(&self) -> KeptOperator {
        self.operator
    }

    /// Value per voxel from what the textures hold.
    pub fn scale(&self) -> f32 {
        self.scale
    }

    /// Those of the bricks of the volume, in their order, in [`Use::Sampled`] once they are recorded.
    pub fn images(&self) -> &[Image] {
        &self.images
    }

    /// Records what fills them, once.
    ///
    /// # Errors
    /// A brick larger than the device can dispatch.
    ///
    /// # Safety
    /// - `cmd` is recording, outside rendering; `self` and the volume live until it has run;
    /// - the volume's textures (or those of its gradient source) are in [`Use::Sampled`].
    pub unsafe fn record(&self, cmd: vk::CommandBuffer) -> Result<(), Error> {
        // SAFETY: the caller's promises.
        unsafe { self.record_part(cmd, 0..u64::MAX) }
    }

    /// Workgroups of all bricks: [`KeptGradients::record_part`] records some of them.
    ///
    /// # Errors
    /// A brick larger than the device can dispatch.
    pub fn group_count(&self) -> Result<u64, Error> {
        let groups = |&extent: &[u32; 3]| Ok(group_count(self.pipeline.groups(extent)?));
        self.extents.iter().map(groups).sum()
    }

    /// The same as [`KeptGradients::record`] for a part of the work, so that no submission takes long: parts follow
    /// each other, each begins where the one before ended. No barriers are needed between them.
    ///
    /// # Errors
    /// As [`KeptGradients::record`].
    ///
    /// # Safety
    /// As [`KeptGradients::record`], in the order of the parts.
    pub unsafe fn record_part(
        &self,
        cmd: vk::CommandBuffer,
        part: Range<u64>,
    ) -> Result<(), Error> {
        let bricks = self.images.iter().zip(&self.extents).zip(&self.bindings);
        let mut first = 0;
        for (slot, ((image, &extent), bindings)) in (0..).zip(bricks) {
            let groups = self.pipeline.groups(extent)?;
            let offset = self.ring.offset(slot)?;
            let run = within(&part, first, group_count(groups));
            first += group_count(groups);
            if run.is_empty() {
                continue;
            }
            let (begins, ends) = (run.start == 0, run.end == group_count(groups));
            // SAFETY: the caller's promises; the image is new and written between the barriers.
            unsafe {
                if begins {
                    image_barrier(&self.gpu, cmd, image, Use::Nothing, Use::ComputeWrite);
                }
                self.pipeline
                    .dispatch_run(cmd, bindings, &[offset], groups, run);
                if ends {
                    image_barrier(&self.gpu, cmd, image, Use::ComputeWrite, Use::Sampled);
                }
            }
        }
        Ok(())
    }
}
