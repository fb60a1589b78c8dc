//! The points of a field in buffers of the device.

use crate::gpu::{Buffer, Error, Gpu, Memory};
use crate::points::{FieldPoint, PointField};
use ash::vk::BufferUsageFlags as Usage;
use std::sync::Arc;

/// What the shader reads. The host writes it.
#[derive(Debug)]
pub struct GpuField {
    points: Buffer,
    cells: Buffer,
}

impl GpuField {
    /// Buffers of these points, 20 bytes each, and of cells, eight each.
    ///
    /// # Errors
    /// Where they are over a limit of the device.
    pub fn new(gpu: &Arc<Gpu>, field: &PointField) -> Result<Self, Error> {
        let numbers = |point: &FieldPoint| {
            let [x, y, z] = point.place.as_vec3().to_array();
            [x, y, z, point.value, point.weight]
        };
        let points: Vec<f32> = field.points().iter().flat_map(numbers).collect();
        let cells: Vec<u32> = [field.starts(), &field.distances()].concat();
        let made = |bytes: &[u8], name| {
            let usage = Usage::STORAGE_BUFFER;
            let buffer = Buffer::new(gpu, bytes.len() as u64, usage, Memory::Upload, name)?;
            buffer.write(0, bytes)?;
            Ok(buffer)
        };
        Ok(Self {
            points: made(bytemuck::cast_slice(&points), "points of a field")?,
            cells: made(bytemuck::cast_slice(&cells), "cells of a field")?,
        })
    }

    /// Sorted by cell.
    pub(in crate::technique) fn points(&self) -> &Buffer {
        &self.points
    }

    /// Where the points of each cell begin, the end of the last, and how far each is from the next one with points.
    pub(in crate::technique) fn cells(&self) -> &Buffer {
        &self.cells
    }
}
