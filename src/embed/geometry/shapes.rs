//! Round cones or triangles in buffers of the device, with the pipeline that draws them.

use crate::embed::{Error, GeometryDesc};
use crate::gpu::{
    Bindings, Blend, Buffer, DepthUse, Gpu, Memory, ParameterRing, RasterDesc, RasterPipeline,
    Resource, Use, barriers, buffer_to_buffer,
};
use crate::shaders::shader;
use ash::vk;
use std::sync::Arc;

/// A vertex as shaders read it.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct GpuVertex {
    pub place: [f32; 3],
    pub radius: f32,
    pub color: [f32; 3],
    pub unused: f32,
}

/// What is drawn of some vertices.
pub(super) struct Parts<'a> {
    /// Of errors.
    pub name: &'static str,
    /// The vertex shader and the fragment shader.
    pub shaders: [&'static str; 2],
    pub vertices: Vec<GpuVertex>,
    /// Which of them make the shapes.
    pub numbers: &'a [u32],
    /// Corners that are drawn for each number.
    pub corners_a_number: u64,
}

/// Shapes of one kind.
#[derive(Debug)]
pub(super) struct Shapes {
    pipeline: RasterPipeline,
    bindings: Bindings,
    /// Vertices, and their numbers.
    buffers: [Buffer; 2],
    /// What they are filled from, until that is recorded.
    staging: Option<Buffer>,
    corners: u32,
}

const HELD: vk::BufferUsageFlags = vk::BufferUsageFlags::from_raw(
    vk::BufferUsageFlags::STORAGE_BUFFER.as_raw() | vk::BufferUsageFlags::TRANSFER_DST.as_raw(),
);
const STAGED: vk::BufferUsageFlags = vk::BufferUsageFlags::TRANSFER_SRC;

impl Parts<'_> {
    /// Whether the device has buffers of such sizes, and numbers for all corners.
    pub fn check_limits(&self, gpu: &Gpu) -> Result<(), Error> {
        if self.numbers.is_empty() {
            return Ok(());
        }
        let [vertices, numbers] = self.bytes();
        gpu.check_buffer(vertices, HELD, self.name)?;
        gpu.check_buffer(numbers, HELD, self.name)?;
        gpu.check_buffer(vertices + numbers, STAGED, self.name)?;
        self.corners().map(drop)
    }

    fn corners(&self) -> Result<u32, Error> {
        let wanted = self.numbers.len() as u64 * self.corners_a_number;
        let corners = u32::try_from(wanted).map_err(|_| crate::gpu::Error::Limit {
            doing: format!("draw {}", self.name),
            limit: "the number of a vertex, of 32 bits,",
            wanted,
            allowed: u32::MAX.into(),
        })?;
        Ok(corners)
    }

    /// In both buffers.
    pub fn bytes(&self) -> [u64; 2] {
        [
            size_of_val(&self.vertices[..]) as u64,
            size_of_val(self.numbers) as u64,
        ]
    }
}

impl Shapes {
    /// Buffers, pipeline and descriptor set; `None` where there is no shape.
    pub fn new(
        gpu: &Arc<Gpu>,
        parts: &Parts,
        desc: &GeometryDesc,
        ring: &ParameterRing,
    ) -> Result<Option<Self>, Error> {
        if parts.numbers.is_empty() {
            return Ok(None);
        }
        let name = parts.name;
        let bytes = parts.bytes();
        let vertices = Buffer::new(gpu, bytes[0], HELD, Memory::Device, name)?;
        let numbers = Buffer::new(gpu, bytes[1], HELD, Memory::Device, name)?;
        let staging = Buffer::new(gpu, bytes[0] + bytes[1], STAGED, Memory::Upload, "staging")?;
        staging.write(0, bytemuck::cast_slice(&parts.vertices))?;
        staging.write(bytes[0], bytemuck::cast_slice(parts.numbers))?;
        let [vertex, fragment] = parts.shaders.map(shader);
        let pipeline = RasterPipeline::new(
            gpu,
            &RasterDesc {
                vertex,
                fragment,
                target: desc.target,
                blend: Blend::Replace,
                depth: DepthUse::Opaque,
            },
        )?;
        let bound = [
            ("view", Resource::Uniform(ring)),
            ("vertices", Resource::Storage(&vertices)),
            ("numbers", Resource::Storage(&numbers)),
        ];
        let bindings = Bindings::new(gpu, pipeline.layout(), &bound)?;
        Ok(Some(Self {
            pipeline,
            bindings,
            buffers: [vertices, numbers],
            staging: Some(staging),
            corners: parts.corners()?,
        }))
    }

    /// Records the copies, and what makes them readable.
    ///
    /// # Safety
    /// As [`super::Geometry::record_upload`].
    pub unsafe fn record_upload(&mut self, gpu: &Gpu, cmd: vk::CommandBuffer) -> Result<(), Error> {
        let Some(staging) = &self.staging else {
            return Ok(());
        };
        let [vertices, numbers] = &self.buffers;
        let part = |src_offset, size| vk::BufferCopy {
            src_offset,
            dst_offset: 0,
            size,
        };
        let (first, second) = (vertices.bytes(), numbers.bytes());
        // SAFETY: the caller's promises; nothing uses the buffers yet.
        unsafe {
            buffer_to_buffer(gpu, cmd, staging, vertices, &[part(0, first)])?;
            buffer_to_buffer(gpu, cmd, staging, numbers, &[part(first, second)])?;
            let written =
                [vertices, numbers].map(|buffer| (buffer, Use::TransferWrite, Use::DrawRead));
            barriers(gpu, cmd, [], written, []);
        }
        self.staging = None;
        Ok(())
    }

    /// Draws all of them with the parameters at `offset` of the ring.
    ///
    /// # Safety
    /// As [`super::Geometry::draw`], with viewport and scissor set.
    pub unsafe fn draw(&self, cmd: vk::CommandBuffer, offset: u32) {
        // SAFETY: the caller's promises; the bindings were made for this pipeline.
        unsafe {
            self.pipeline
                .draw(cmd, &self.bindings, &[offset], self.corners, 0..1)
        };
    }
}
