//! A raster pipeline for dynamic rendering or a render pass: triangles, no vertex buffers, no culling.

#[cfg(feature = "conformance")]
use super::recorder;
use super::{
    Bindings, Buffer, Error, Gpu, Layout, pipeline::first, pipeline::module, pipeline::stage,
    pipeline::wrong_stage, pipelines::Key, pipelines::Pipeline,
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

/// What is drawn into, as far as a pipeline has to know: rendering of our own, or a host's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TargetClass {
    /// The one color target.
    pub color_format: vk::Format,
    /// Samples of each target.
    pub samples: vk::SampleCountFlags,
    /// The depth attachment, where the rendering has one.
    pub depth: Option<DepthClass>,
    /// A render pass of the host's; `None`: dynamic rendering.
    pub pass: Option<HostPass>,
}

/// A render pass of the host's and the subpass that is drawn in, with the color target as its first color attachment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct HostPass {
    raw: vk::RenderPass,
    subpass: u32,
}

impl HostPass {
    /// # Safety
    /// The render pass is one of the device that pipelines are made on for it, has that subpass, and lives until they
    /// are made.
    pub unsafe fn new(raw: vk::RenderPass, subpass: u32) -> Self {
        Self { raw, subpass }
    }
}

/// The depth attachment of a host's rendering.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct DepthClass {
    /// Its format.
    pub format: vk::Format,
    /// The rendering has the same image as stencil attachment too.
    pub has_stencil: bool,
    /// The larger of two depths is the nearer one.
    pub is_reversed: bool,
}

/// What a pipeline does with the depth attachment, where there is one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DepthUse {
    /// Nothing.
    #[default]
    Ignored,
    /// Draws what is not behind it.
    Tested,
    /// Draws no color, and writes what is not behind it.
    Written,
    /// Draws what is nearer, and writes its depth: of two that are equally near the first stays.
    Opaque,
}

impl From<vk::Format> for TargetClass {
    /// Dynamic rendering to one color target.
    fn from(color_format: vk::Format) -> Self {
        Self {
            color_format,
            samples: vk::SampleCountFlags::TYPE_1,
            depth: None,
            pass: None,
        }
    }
}

/// What to compile.
#[derive(Clone, Copy, Debug)]
pub struct RasterDesc<'a> {
    /// Makes positions from the vertex index.
    pub vertex: &'a Shader,
    /// Makes colors. Its name stands for the pipeline.
    pub fragment: &'a Shader,
    /// What it draws into.
    pub target: TargetClass,
    /// What becomes of the target.
    pub blend: Blend,
    /// What becomes of its depth.
    pub depth: DepthUse,
}

/// Two shaders, ready to draw. Viewport and scissor are dynamic.
#[derive(Debug)]
pub struct RasterPipeline {
    raw: Pipeline,
    layout: Layout,
}

impl RasterPipeline {
    /// Compiles, after the formats were found to do what is asked of them.
    pub fn new(gpu: &Arc<Gpu>, desc: &RasterDesc<'_>) -> Result<Self, Error> {
        Self::of(gpu, desc, vk::PrimitiveTopology::TRIANGLE_LIST)
    }

    /// The same for points in the place of triangles, whose vertices say how large they are: at most
    /// [`super::Caps::max_point_pixels`].
    pub fn of_points(gpu: &Arc<Gpu>, desc: &RasterDesc<'_>) -> Result<Self, Error> {
        Self::of(gpu, desc, vk::PrimitiveTopology::POINT_LIST)
    }

    fn of(
        gpu: &Arc<Gpu>,
        desc: &RasterDesc<'_>,
        topology: vk::PrimitiveTopology,
    ) -> Result<Self, Error> {
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
        let key = Key {
            shaders: vec![*desc.vertex, *desc.fragment],
            raster: Some((topology, desc.target, desc.blend, desc.depth)),
        };
        let make = || Self::compiled(gpu, desc, topology, &layout);
        let raw = Pipeline::new(gpu, key, name, make)?;
        Ok(Self { raw, layout })
    }

    fn compiled(
        gpu: &Arc<Gpu>,
        desc: &RasterDesc<'_>,
        topology: vk::PrimitiveTopology,
        layout: &Layout,
    ) -> Result<vk::Pipeline, Error> {
        let doing = || format!("make raster pipeline `{}`", desc.fragment.name);
        let (vertex, fragment) = (module(gpu, desc.vertex)?, module(gpu, desc.fragment)?);
        let stages = [stage(desc.vertex, &vertex), stage(desc.fragment, &fragment)];
        let vertex_input = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(topology);
        let viewport = vk::PipelineViewportStateCreateInfo::default()
            .viewport_count(1)
            .scissor_count(1);
        let rasterization = vk::PipelineRasterizationStateCreateInfo::default()
            .polygon_mode(vk::PolygonMode::FILL)
            .cull_mode(vk::CullModeFlags::NONE)
            .line_width(1.0);
        let samples = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(desc.target.samples);
        let attachments = [match desc.depth {
            DepthUse::Written => vk::PipelineColorBlendAttachmentState::default(),
            DepthUse::Ignored | DepthUse::Tested | DepthUse::Opaque => desc.blend.attachment(),
        }];
        let depth = desc.depth.state(desc.target.depth);
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&attachments);
        let dynamic = vk::PipelineDynamicStateCreateInfo::default()
            .dynamic_states(&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR]);
        let color_formats = [desc.target.color_format];
        let mut rendering = desc.target.rendering(&color_formats);
        let mut info = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stages)
            .vertex_input_state(&vertex_input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&rasterization)
            .multisample_state(&samples)
            .color_blend_state(&blend)
            .depth_stencil_state(&depth)
            .dynamic_state(&dynamic)
            .layout(layout.raw());
        info = match desc.target.pass {
            Some(pass) => info.render_pass(pass.raw).subpass(pass.subpass),
            None => info.push_next(&mut rendering),
        };
        // SAFETY: modules and layout were made of the same shaders, whose SPIR-V `build.rs` has validated.
        first(gpu, doing, |device| unsafe {
            device.create_graphics_pipelines(gpu.pipeline_cache, &[info], None)
        })
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
        #[cfg(feature = "conformance")]
        recorder::note(recorder::Event::Draw {
            shader: self.layout.name(),
            vertices,
            instances: [instances.start, instances.end],
        });
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
        #[cfg(feature = "conformance")]
        recorder::note(recorder::Event::DrawIndirect {
            shader: self.layout.name(),
            buffer: draws.name(),
        });
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
    let lacks = |format, lacks| {
        Err(Error::Format {
            doing: doing(),
            format,
            lacks,
        })
    };
    let format = desc.target.color_format;
    let features = gpu.format_features(format);
    if !features.color {
        return lacks(format, "color target");
    }
    if desc.blend != Blend::Replace && !features.blend {
        return lacks(format, "blending");
    }
    match (desc.target.depth, desc.depth) {
        (Some(depth), _) if !gpu.format_features(depth.format).depth => {
            lacks(depth.format, "depth attachment")
        }
        (None, DepthUse::Tested | DepthUse::Written | DepthUse::Opaque) => Err(Error::Argument {
            doing: doing(),
            wanted: "a target with a depth attachment".into(),
            found: "none".into(),
        }),
        _ => Ok(()),
    }
}

impl TargetClass {
    fn rendering<'a>(
        &self,
        color_formats: &'a [vk::Format],
    ) -> vk::PipelineRenderingCreateInfo<'a> {
        let info =
            vk::PipelineRenderingCreateInfo::default().color_attachment_formats(color_formats);
        match self.depth {
            None => info,
            Some(depth) => {
                let info = info.depth_attachment_format(depth.format);
                match depth.has_stencil {
                    true => info.stencil_attachment_format(depth.format),
                    false => info,
                }
            }
        }
    }
}

impl DepthUse {
    /// Nearest wins, and so does what has the same depth, but for what is opaque.
    fn state(self, class: Option<DepthClass>) -> vk::PipelineDepthStencilStateCreateInfo<'static> {
        let is_reversed = class.is_some_and(|class| class.is_reversed);
        let nearer = match (is_reversed, self) {
            (true, Self::Opaque) => vk::CompareOp::GREATER,
            (false, Self::Opaque) => vk::CompareOp::LESS,
            (true, _) => vk::CompareOp::GREATER_OR_EQUAL,
            (false, _) => vk::CompareOp::LESS_OR_EQUAL,
        };
        vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(self != Self::Ignored)
            .depth_write_enable(matches!(self, Self::Written | Self::Opaque))
            .depth_compare_op(nearer)
    }
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
