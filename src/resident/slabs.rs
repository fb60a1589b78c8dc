//! A transfer function's integrals on the device: four texels a cell, folded into rows.

use super::transfer::filled;
use crate::gpu::{Buffer, Error, Gpu, Image, ImageDesc, ImageKind, Region, Use};
use crate::gpu::{buffer_to_image, image_barrier};
use crate::shaders::SLAB_TABLE_WIDTH;
use crate::transfer::{SlabCell, SlabTable};
use ash::vk;
use std::sync::Arc;

/// The table of pre-integrated classification.
#[derive(Debug)]
pub(super) struct GpuSlabs {
    pub table: Image,
    staging: Buffer,
}

impl GpuSlabs {
    pub fn new(gpu: &Arc<Gpu>, table: &SlabTable) -> Result<Self, Error> {
        let parts = |cell: &SlabCell| [cell.mean, cell.slope, cell.sum, cell.sum_rest];
        let mut texels: Vec<_> = table.cells.iter().flat_map(parts).collect();
        let width = SLAB_TABLE_WIDTH as usize;
        texels.resize(texels.len().next_multiple_of(width), [0.0; 4]);
        let desc = ImageDesc {
            kind: ImageKind::D2,
            extent: [width as u32, (texels.len() / width) as u32, 1],
            format: vk::Format::R32G32B32A32_SFLOAT,
            usage: vk::ImageUsageFlags::SAMPLED
                | vk::ImageUsageFlags::STORAGE
                | vk::ImageUsageFlags::TRANSFER_DST,
            name: "slab table",
        };
        let copied = vk::BufferUsageFlags::TRANSFER_SRC;
        Ok(Self {
            table: Image::new(gpu, &desc)?,
            staging: filled(gpu, &texels, copied, "slab staging")?,
        })
    }

    /// # Safety
    /// As [`super::GpuTransfer::record_upload`].
    pub unsafe fn record_upload(&self, gpu: &Gpu, cmd: vk::CommandBuffer) -> Result<(), Error> {
        let table = &self.table;
        // SAFETY: the caller's promises; the table is new and the staging buffer is full.
        unsafe {
            image_barrier(gpu, cmd, table, Use::Nothing, Use::TransferWrite);
            buffer_to_image(gpu, cmd, &self.staging, 0, table, Region::whole(table))?;
            image_barrier(gpu, cmd, table, Use::TransferWrite, Use::SampledOrRead);
        }
        Ok(())
    }
}
