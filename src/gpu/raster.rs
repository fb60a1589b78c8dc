//! A raster pipeline for dynamic rendering: triangles, no vertex buffers, no depth, no culling.

use super::{
    Bindings, Buffer, Error, Gpu, Layout, error::within, owned::Own, pipeline::first,
    pipeline::module, pipeline::stage, pipeline::wrong_stage,
};
use crate::shaders::{Shader, Stage};
use ash::vk;
use std::{ops::Range, sync::Arc};

/// What becomes of the target. Colors are premultiplied.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Blend {
    /// new
    Replace,
    /// new + (1 - new alpha) old: back to front
    Over,
    /// (1 - old alpha) new + old: front to back
    Under,
    /// new + old
    Add,
    /// the larger, channel by channel
    Max,
    /// the smaller, channel by channel
    Min,
}

/// What to compile.
#[derive(Clone, Copy, Debug)]
pub struct RasterDesc<'a> {
    /// Makes positions from the vertex index.
    pub vertex: &'a Shader,
    /// Makes colors. Its name stands for the pipeline.
    pub fragment: &'a Shader,
    /// One for each color target, in order of location.
    pub color_formats: &'a [vk::Format],
    /// For all targets alike: another blend for each needs a feature.
    pub blend: Blend,
}

/// Two shaders, ready to draw. Viewport and scissor are dynamic.
#[derive(Debug)]
pub struct RasterPipeline {
    raw: Own<vk::Pipeline>,
    layout: Layout,
}

impl RasterPipeline {
    /// Compiles, after the formats were found to do what is asked of them.
    pub fn new(gpu: &Arc<Gpu>, desc: &RasterDesc<'_>) -> Result<Self, Error> {
        let name = desc.fragment.name;
        let doing = || format!("make raster pipeline `{name}`");
        if desc.vertex.stage != Stage::Vertex {
            return Err(wrong_stage(doing(), "a vertex shader", desc.vertex));
        }
        if desc.fragment.stage != Stage::Fragment {
            return Err(wrong_stage(doing(), "a fragment shader", desc.fragment));
        }
        check_formats(gpu, desc)?;
        let layout = Layout::new(gpu, &[desc.vertex, desc.fragment], name)?;
        let (vertex, fragment) = (module(gpu, desc.vertex)?, module(gpu, desc.fragment)?);
        let stages = [stage(desc.vertex, &vertex), stage(desc.fragment, &fragment)];
        let vertex_input = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport = vk::PipelineViewportStateCreateInfo::default()
            .viewport_count(1)
            .scissor_count(1);
        let rasterization = vk::PipelineRasterizationStateCreateInfo::default()
            .polygon_mode(vk::PolygonMode::FILL)
            .cull_mode(vk::CullModeFlags::NONE)
            .line_width(1.0);
        let samples = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let attachments = vec![desc.blend.attachment(); desc.color_formats.len()];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&attachments);
        let dynamic = vk::PipelineDynamicStateCreateInfo::default()
            .dynamic_states(&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR]);
        let mut rendering =
            vk::PipelineRenderingCreateInfo::default().color_attachment_formats(desc.color_formats);
        let info = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stages)
            .vertex_input_state(&vertex_input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&rasterization)
            .multisample_state(&samples)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(layout.raw())
            .push_next(&mut rendering);
        // SAFETY: modules and layout were made of the same shaders, whose SPIR-V `build.rs` has validated.
        let raw = first(gpu, doing, |device| unsafe {
            device.create_graphics_pipelines(gpu.pipeline_cache, &[info], None)
        })?;
        gpu.name(raw.get(), name);
        Ok(Self { raw, layout })
    }

    /// The Vulkan handle.
    pub fn raw(&self) -> vk::Pipeline {
        self.raw.get()
    }

    /// What has to be bound.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Binds pipeline and bindings and draws `vertices`, three a triangle, once for each of `instances`.
    ///
    /// `offsets` are the dynamic offsets ([`super::ParameterRing::offset`]) of the uniform bindings, in order of
    /// their numbers.
    ///
    /// # Safety
    ///
    /// - `cmd` is recording on our device, inside dynamic rendering to targets of the pipeline's formats, with
    ///   viewport and scissor set;
    /// - `bindings` were made for an equal layout; pipeline, bindings and what is bound live until `cmd` has run;
    /// - there is one offset a uniform binding.
    pub unsafe fn draw(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &Bindings,
        offsets: &[u32],
        vertices: u32,
        instances: Range<u32>,
    ) {
        let point = vk::PipelineBindPoint::GRAPHICS;
        let sets = [bindings.raw()];
        // SAFETY: the caller's promises are all that these calls ask.
        self.raw.gpu().record(|device| unsafe {
            device.cmd_bind_pipeline(cmd, point, self.raw());
            device.cmd_bind_descriptor_sets(cmd, point, self.layout.raw(), 0, &sets, offsets);
            let count = instances.end.saturating_sub(instances.start);
            device.cmd_draw(cmd, vertices, count, 0, instances.start);
        });
    }

    /// Binds pipeline and bindings and draws what `draws` say: `VkDrawIndirectCommand`s, one after the other.
    ///
    /// # Safety
    ///
    /// As [`Self::draw`]; `draws` has `INDIRECT_BUFFER` usage, holds `numbers` and is in `Use::DrawIndirect`, and what
    /// it holds draws triangles from instance 0.
    pub unsafe fn draw_indirect(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &Bindings,
        offsets: &[u32],
        draws: &Buffer,
        numbers: Range<u32>,
    ) {
        let point = vk::PipelineBindPoint::GRAPHICS;
        let sets = [bindings.raw()];
        let bytes = size_of::<vk::DrawIndirectCommand>() as u64;
        // SAFETY: the caller's promises. One draw a call: more are a feature.
        self.raw.gpu().record(|device| unsafe {
            device.cmd_bind_pipeline(cmd, point, self.raw());
            device.cmd_bind_descriptor_sets(cmd, point, self.layout.raw(), 0, &sets, offsets);
            for number in numbers {
                device.cmd_draw_indirect(cmd, draws.raw(), u64::from(number) * bytes, 1, 0);
            }
        });
    }
}

fn check_formats(gpu: &Gpu, desc: &RasterDesc<'_>) -> Result<(), Error> {
    let doing = || format!("make raster pipeline `{}`", desc.fragment.name);
    let allowed = gpu.limits().max_color_attachments.into();
    within(
        doing,
        "maxColorAttachments",
        desc.color_formats.len() as u64,
        allowed,
    )?;
    for &format in desc.color_formats {
        let features = gpu.format_features(format);
        if !features.color {
            return Err(Error::Format {
                doing: doing(),
                format,
                lacks: "color target",
            });
        }
        if desc.blend != Blend::Replace && !features.blend {
            return Err(Error::Format {
                doing: doing(),
                format,
                lacks: "blending",
            });
        }
    }
    Ok(())
}

impl Blend {
    fn attachment(self) -> vk::PipelineColorBlendAttachmentState {
        use vk::{BlendFactor as Factor, BlendOp as Op};
        // Factors of Max and Min are ignored by Vulkan.
        let (new, old, op) = match self {
            Self::Replace => (Factor::ONE, Factor::ZERO, Op::ADD),
            Self::Over => (Factor::ONE, Factor::ONE_MINUS_SRC_ALPHA, Op::ADD),
            Self::Under => (Factor::ONE_MINUS_DST_ALPHA, Factor::ONE, Op::ADD),
            Self::Add => (Factor::ONE, Factor::ONE, Op::ADD),
            Self::Max => (Factor::ONE, Factor::ONE, Op::MAX),
            Self::Min => (Factor::ONE, Factor::ONE, Op::MIN),
        };
        vk::PipelineColorBlendAttachmentState::default()
            .blend_enable(self != Self::Replace)
            .src_color_blend_factor(new)
            .dst_color_blend_factor(old)
            .color_blend_op(op)
            .src_alpha_blend_factor(new)
            .dst_alpha_blend_factor(old)
            .alpha_blend_op(op)
            .color_write_mask(vk::ColorComponentFlags::RGBA)
    }
}
