//! A transfer function on the device: a table for speed, its control points for exactness.

use super::slabs::GpuSlabs;
use crate::gpu::{
    Buffer, Error, Gpu, Image, ImageDesc, ImageKind, Memory, Region, Use, buffer_to_image,
    image_barrier,
};
use crate::picture::ColorSpace;
use crate::shaders::TABLE_WIDTH;
use crate::transfer::{
    Absorption, Interpolation, PackedWidgets, Points, SlabTable, Table, TransferFunction,
};
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
    /// Of a medium, behind those of opacity.
    pub emission_point_count: u32,
    /// The numbers of opacity points are extinctions times `reference_length`.
    pub opacity_is_extinction: bool,
    pub extinction_is_colored: bool,
    /// Colours are linear numbers already, albedos.
    pub colors_are_linear: bool,
    /// Where the numbers of [`PackedWidgets`] begin, behind all points.
    pub first_widget_entry: u32,
    pub interpolation: Interpolation,
    pub reference_length: f32,
    /// Where the table begins in a texture of several, and the points in a list of several.
    pub table_row: u32,
    pub point_first: u32,
    /// As those of the table, for the integrals of slabs; 0 without them.
    pub slab_first: f32,
    pub slab_scale: f32,
    pub slab_count: u32,
}

/// One transfer function, or several of which each has a table of its own. The points are there at once;
/// [`GpuTransfer::record_upload`] fills the table.
#[derive(Debug)]
pub struct GpuTransfer {
    gpu: Arc<Gpu>,
    layouts: Vec<TransferLayout>,
    table: Image,
    staging: Buffer,
    numbers: Buffer,
    slabs: Option<GpuSlabs>,
    uses_gradient: bool,
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
        Self::several(gpu, &[(function, reference_length)], space)
    }

    /// Objects for the functions of channels, each with the length that its opacities are for.
    ///
    /// # Errors
    /// Where the device gives no memory.
    pub fn several(
        gpu: &Arc<Gpu>,
        functions: &[(&TransferFunction, f64)],
        space: ColorSpace,
    ) -> Result<Self, Error> {
        let extinction = |reference_length| Absorption::Extinction { reference_length };
        let functions = functions.iter().map(|&(f, length)| (f, extinction(length)));
        Self::absorbing(gpu, &functions.collect::<Vec<_>>(), space)
    }

    /// The same of functions of which each says what its matter takes away.
    ///
    /// # Errors
    /// Where the device gives no memory.
    pub fn absorbing(
        gpu: &Arc<Gpu>,
        functions: &[(&TransferFunction, Absorption)],
        space: ColorSpace,
    ) -> Result<Self, Error> {
        let tables = functions
            .iter()
            .map(|&(function, absorption)| Table::new(function, absorption, space));
        let tables: Vec<_> = tables.collect();
        let longest = tables.iter().map(|table| table.entries.len()).max();
        let width = longest.unwrap_or(1).min(TABLE_WIDTH as usize);
        let (mut entries, mut numbers, mut layouts) = (Vec::new(), Vec::new(), Vec::new());
        for (table, &(function, absorption)) in tables.iter().zip(functions) {
            let own = Points::new(function, absorption, space);
            let medium = function.medium.as_ref().filter(|_| own.are_extinctions);
            layouts.push(TransferLayout {
                table_first: table.first,
                table_scale: table.scale,
                table_count: table.entries.len() as u32,
                color_point_count: own.color_count,
                opacity_point_count: own.opacity_count,
                emission_point_count: own.emission_count,
                opacity_is_extinction: own.are_extinctions,
                extinction_is_colored: medium.is_some_and(|medium| medium.has_colored_extinction()),
                colors_are_linear: space == ColorSpace::Linear && !own.decode,
                first_widget_entry: 0,
                interpolation: function.interpolation,
                reference_length: own.reference_length() as f32,
                table_row: (entries.len() / width) as u32,
                point_first: numbers.len() as u32,
                slab_first: 0.0,
                slab_scale: 0.0,
                slab_count: 0,
            });
            entries.extend_from_slice(&table.entries);
            entries.resize(entries.len().next_multiple_of(width), [0.0; 4]);
            numbers.extend_from_slice(&own.entries);
        }
        // Gradients count where a function is alone.
        let widgets = functions.first();
        let widgets = widgets
            .map(|&(f, absorption)| PackedWidgets::new(f, absorption.reference_length(), space));
        for layout in &mut layouts {
            layout.first_widget_entry = numbers.len() as u32;
        }
        match widgets {
            Some(widgets) => numbers.extend_from_slice(&widgets.entries),
            None => numbers.push([0.0; 4]),
        }
        let desc = ImageDesc {
            kind: ImageKind::D2,
            extent: [width as u32, (entries.len() / width) as u32, 1],
            format: vk::Format::R32G32B32A32_SFLOAT,
            usage: vk::ImageUsageFlags::SAMPLED
                | vk::ImageUsageFlags::STORAGE
                | vk::ImageUsageFlags::TRANSFER_DST,
            name: "transfer table",
        };
        let copied = vk::BufferUsageFlags::TRANSFER_SRC;
        let read = vk::BufferUsageFlags::STORAGE_BUFFER;
        Ok(Self {
            gpu: Arc::clone(gpu),
            layouts,
            table: Image::new(gpu, &desc)?,
            staging: filled(gpu, &entries, copied, "transfer staging")?,
            numbers: filled(gpu, &numbers, read, "transfer numbers")?,
            slabs: None,
            uses_gradient: functions
                .iter()
                .any(|(function, _)| function.uses_gradient()),
        })
    }

    /// As [`GpuTransfer::new`], with the integrals that pre-integrated classification reads.
    ///
    /// # Errors
    /// Where the device gives no memory.
    pub fn preintegrated(
        gpu: &Arc<Gpu>,
        function: &TransferFunction,
        reference_length: f64,
        space: ColorSpace,
    ) -> Result<Self, Error> {
        let mut made = Self::new(gpu, function, reference_length, space)?;
        let absorption = Absorption::Extinction { reference_length };
        let slabs = SlabTable::new(function, absorption, space);
        let layout = &mut made.layouts[0];
        (layout.slab_first, layout.slab_scale) = (slabs.first, slabs.scale);
        layout.slab_count = slabs.cells.len() as u32;
        made.slabs = Some(GpuSlabs::new(gpu, &slabs)?);
        Ok(made)
    }

    /// How table and points of the (first) function are to be read.
    pub fn layout(&self) -> &TransferLayout {
        &self.layouts[0]
    }

    /// The same of every function, in their order.
    pub fn layouts(&self) -> &[TransferLayout] {
        &self.layouts
    }

    /// The table, in [`Use::SampledOrRead`] after the upload.
    pub fn table(&self) -> &Image {
        &self.table
    }

    /// The integrals, where it was made with them; in [`Use::SampledOrRead`] after the upload.
    pub fn slab_table(&self) -> Option<&Image> {
        self.slabs.as_ref().map(|slabs| &slabs.table)
    }

    /// The control points of all functions, and behind them what the gradient makes of the first.
    pub fn numbers(&self) -> &Buffer {
        &self.numbers
    }

    /// Whether gradients count in a function.
    pub fn uses_gradient(&self) -> bool {
        self.uses_gradient
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
                Use::SampledOrRead,
            );
            if let Some(slabs) = &self.slabs {
                slabs.record_upload(&self.gpu, cmd)?;
            }
        }
        Ok(())
    }
}

pub(super) fn filled(
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
