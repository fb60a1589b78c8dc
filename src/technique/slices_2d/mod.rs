//! 2D texture slicing: three stacks of axis-aligned slices, blended in hardware.

pub mod reference;
mod stack;

pub use stack::{set_slices, stack_axis};

use super::blend::{Drawn, operator};
use super::{Inputs, Order, Words};
use crate::gpu::{Bindings, Error, Gpu, RasterDesc, RasterPipeline, set_area};
use crate::shaders::shader;
use ash::vk;
use std::ops::Range;
use std::sync::Arc;

/// Vertices of one slice's cover.
const VERTICES: u32 = 6;

/// The pipeline that draws all slices of a picture in one instanced draw.
#[derive(Debug)]
pub struct Slices2d {
    gpu: Arc<Gpu>,
    pipeline: RasterPipeline,
}

impl Slices2d {
    /// Compiles the variant of these words for a target of `format`.
    ///
    /// # Errors
    /// Where the device does not blend that format, by its name.
    pub fn new(
        gpu: &Arc<Gpu>,
        drawn: Drawn,
        order: Order,
        words: &Words,
        format: vk::Format,
    ) -> Result<Self, Error> {
        let desc = RasterDesc {
            vertex: shader("slices_2d_cover"),
            fragment: shader(&drawn.shader_name("slices_2d", words)),
            color_formats: &[format],
            blend: operator(drawn, order),
        };
        Ok(Self {
            gpu: Arc::clone(gpu),
            pipeline: RasterPipeline::new(gpu, &desc)?,
        })
    }

    /// Binds the inputs.
    ///
    /// # Errors
    /// Where an input is missing.
    pub fn bind(&self, inputs: &Inputs) -> Result<Bindings, Error> {
        inputs.bind(&self.gpu, self.pipeline.layout(), &[])
    }

    /// Records the draw of `slices` (counted in the order of drawing) of the parameters at `offset` of the ring, and sets viewport and
    /// scissor to the whole target.
    ///
    /// The target holds [`super::blend::clear_color`] before. Compositing from back to front also goes over
    /// premultiplied colour that a host has drawn.
    ///
    /// # Safety
    /// - `cmd` is recording, inside rendering to one target of the pipeline's format and of `extent`;
    /// - what was bound lives until it has run; the inputs are in `Use::Sampled`.
    pub unsafe fn record(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &Bindings,
        offset: u32,
        extent: [u32; 2],
        slices: Range<u32>,
    ) {
        // SAFETY: the caller's promises; the bindings come from `bind`.
        unsafe {
            set_area(&self.gpu, cmd, extent);
            self.pipeline
                .draw(cmd, bindings, &[offset], VERTICES, slices);
        }
    }
}
