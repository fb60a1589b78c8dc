//! A transfer function on the device: a table for speed, its control points for exactness.

use crate::gpu::{
    Buffer, Error, Gpu, Image, ImageDesc, ImageKind, Memory, Region, Use, buffer_to_image,
    image_barrier,
};
use crate::picture::ColorSpace;
use crate::shaders::TABLE_WIDTH;
use crate::transfer::{Absorption, Interpolation, Points, Table, TransferFunction};
use ash::vk;
use std::sync::Arc;

/// How a transfer function lies in its table and its points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(missing_docs, reason = "see `transfer::Table` and `transfer::Points`")]
pub struct TransferLayout {
    pub table_first: f32,
    pub table_scale: f32,
    pub table_count: u32,
    pub color_point_count: u32,
    pub opacity_point_count: u32,
    pub interpolation: Interpolation,
    pub reference_length: f32,
}

/// A transfer function. The points are there at once; [`GpuTransfer::record_upload`] fills the table.
#[derive(Debug)]
pub struct GpuTransfer {
    gpu: Arc<Gpu>,
    layout: TransferLayout,
    table: Image,
    staging: Buffer,
    points: Buffer,
}

impl GpuTransfer {
    /// Objects for `function`, whose opacities are for `reference_length` world length.
    ///
    /// # Errors
    /// Where the device gives no memory.
    pub fn new(
        gpu: &Arc<Gpu>,
        function: &TransferFunction,
        reference_length: f64,
        space: ColorSpace,
    ) -> Result<Self, Error> {
        let absorption = Absorption::Extinction { reference_length };
        let table = Table::new(function, absorption, space);
        let points = Points::new(function, absorption, space);
        let width = (TABLE_WIDTH as usize).min(table.entries.len());
        let desc = ImageDesc {
            kind: ImageKind::D2,
            extent: [width as u32, (table.entries.len() / width) as u32, 1],
            format: vk::Format::R32G32B32A32_SFLOAT,
            usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
            name: "transfer table",
        };
        Ok(Self {
            gpu: Arc::clone(gpu),
            layout: TransferLayout {
                table_first: table.first,
                table_scale: table.scale,
                table_count: table.entries.len() as u32,
                color_point_count: points.color_count,
                opacity_point_count: points.opacity_count,
                interpolation: function.interpolation,
                reference_length: reference_length as f32,
            },
            table: Image::new(gpu, &desc)?,
            staging: filled(
                gpu,
                &table.entries,
                vk::BufferUsageFlags::TRANSFER_SRC,
                "transfer staging",
            )?,
            points: filled(
                gpu,
                &points.entries,
                vk::BufferUsageFlags::STORAGE_BUFFER,
                "transfer points",
            )?,
        })
    }

    /// How table and points are to be read.
    pub fn layout(&self) -> &TransferLayout {
        &self.layout
    }

    /// The table, in [`Use::Sampled`] after the upload.
    pub fn table(&self) -> &Image {
        &self.table
    }

    /// The control points.
    pub fn points(&self) -> &Buffer {
        &self.points
    }

    /// Records the copy that fills the table.
    ///
    /// # Errors
    /// None but a mistake of ours.
    ///
    /// # Safety
    /// `cmd` is recording, outside rendering; `self` lives until it has run.
    pub unsafe fn record_upload(&self, cmd: vk::CommandBuffer) -> Result<(), Error> {
        let region = Region::whole(&self.table);
        // SAFETY: the caller's promises; the table is new and the staging buffer is full.
        unsafe {
            image_barrier(
                &self.gpu,
                cmd,
                &self.table,
                Use::Nothing,
                Use::TransferWrite,
            );
            buffer_to_image(&self.gpu, cmd, &self.staging, 0, &self.table, region)?;
            image_barrier(
                &self.gpu,
                cmd,
                &self.table,
                Use::TransferWrite,
                Use::Sampled,
            );
        }
        Ok(())
    }
}

fn filled(
    gpu: &Arc<Gpu>,
    entries: &[[f32; 4]],
    usage: vk::BufferUsageFlags,
    name: &str,
) -> Result<Buffer, Error> {
    let bytes: &[u8] = bytemuck::cast_slice(entries);
    let buffer = Buffer::new(gpu, bytes.len() as u64, usage, Memory::Upload, name)?;
    buffer.write(0, bytes)?;
    Ok(buffer)
}
