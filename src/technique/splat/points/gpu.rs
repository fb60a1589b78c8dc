//! Points of a view in buffers of the device.

use super::view_points::{ViewPoint, ViewPoints};
use crate::gpu::{Buffer, Error, Gpu, Memory};
use ash::vk::BufferUsageFlags as Usage;
use std::sync::Arc;

/// A point in the buffer: the struct of `shaders/lib/view_points.wgsl`.
const POINT_BYTES: usize = 32;

/// What the shader reads. The host writes it.
#[derive(Debug)]
pub struct GpuViewPoints {
    points: Buffer,
    blocks: Buffer,
}

impl GpuViewPoints {
    /// Buffers of these points.
    ///
    /// # Errors
    /// Where they are over a limit of the device.
    pub fn new(gpu: &Arc<Gpu>, view: &ViewPoints) -> Result<Self, Error> {
        let point = |point: &ViewPoint| {
            let [x, y, z] = point.center;
            [
                x,
                y,
                z,
                point.inverse_std,
                point.value,
                point.length,
                point.density,
                0.0,
            ]
        };
        let points: Vec<f32> = view.points.iter().flat_map(point).collect();
        let blocks: Vec<u32> = view.starts.iter().chain(&view.lists).copied().collect();
        let made = |bytes: &[u8], name| {
            let count = bytes.len().max(POINT_BYTES) as u64;
            let buffer = Buffer::new(gpu, count, Usage::STORAGE_BUFFER, Memory::Upload, name)?;
            buffer.write(0, bytes)?;
            Ok(buffer)
        };
        Ok(Self {
            points: made(bytemuck::cast_slice(&points), "points of a view")?,
            blocks: made(bytemuck::cast_slice(&blocks), "points of blocks")?,
        })
    }

    /// From front to back.
    pub(in crate::technique) fn points(&self) -> &Buffer {
        &self.points
    }

    /// Where the list of each block begins, and the lists.
    pub(in crate::technique) fn blocks(&self) -> &Buffer {
        &self.blocks
    }
}
