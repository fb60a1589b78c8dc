//! A pipeline made for nothing but its statistics.

use super::{cost::Cost, null_device::NullDevice};
use ash::vk;
use std::collections::BTreeMap;
use stratavox::shaders::{BindingKind, Shader, Stage};

/// A shader with the words that it is compiled from.
pub struct Code<'a> {
    pub shader: &'a Shader,
    pub words: &'a [u32],
}

/// The statistics of the first of `codes`: a compute shader, or two stages of a raster pipeline.
pub fn cost(null: &NullDevice, codes: &[Code]) -> Result<Cost, String> {
    let mut made = Made::default();
    let result = made.compile(null, codes).and_then(|()| {
        let stage = stage_flag(codes[0].shader.stage);
        statistics(null, made.pipeline, stage)
    });
    made.destroy(&null.device);
    result.map_err(|result| format!("compile {}: {result}", codes[0].shader.name))
}

/// What one pipeline takes; null until it is made.
#[derive(Default)]
struct Made {
    modules: Vec<vk::ShaderModule>,
    set: vk::DescriptorSetLayout,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
}

impl Made {
    fn compile(&mut self, null: &NullDevice, codes: &[Code]) -> Result<(), vk::Result> {
        let device = &null.device;
        for code in codes {
            let info = vk::ShaderModuleCreateInfo::default().code(code.words);
            // SAFETY: the words are of a module that `build.rs` has validated, or what `spirv-opt` made of it.
            self.modules
                .push(unsafe { device.create_shader_module(&info, None) }?);
        }
        let bindings = bindings(codes);
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        // SAFETY: numbers of bindings differ, being keys of a map.
        self.set = unsafe { device.create_descriptor_set_layout(&info, None) }?;
        let sets = [self.set];
        let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets);
        // SAFETY: the set's layout is of this device.
        self.layout = unsafe { device.create_pipeline_layout(&info, None) }?;
        let stages = codes.iter().zip(&self.modules);
        let stages: Vec<vk::PipelineShaderStageCreateInfo> = stages
            .map(|(code, &module)| {
                vk::PipelineShaderStageCreateInfo::default()
                    .stage(stage_flag(code.shader.stage))
                    .module(module)
                    .name(c"main")
            })
            .collect();
        self.pipeline = match codes {
            [_] => self.compute(device, stages[0]),
            _ => self.raster(device, &stages),
        }?;
        Ok(())
    }

    fn compute(
        &self,
        device: &ash::Device,
        stage: vk::PipelineShaderStageCreateInfo,
    ) -> Result<vk::Pipeline, vk::Result> {
        let info = vk::ComputePipelineCreateInfo::default()
            .flags(
                vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR
                    | vk::PipelineCreateFlags::DISPATCH_BASE,
            )
            .stage(stage)
            .layout(self.layout);
        // SAFETY: module and layout are of the same shader.
        let made =
            unsafe { device.create_compute_pipelines(vk::PipelineCache::null(), &[info], None) };
        made.map(|made| made[0]).map_err(|(_, result)| result)
    }

    /// As slicers blend: premultiplied colours, back to front, into floats.
    fn raster(
        &self,
        device: &ash::Device,
        stages: &[vk::PipelineShaderStageCreateInfo],
    ) -> Result<vk::Pipeline, vk::Result> {
        let vertex_input = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport = vk::PipelineViewportStateCreateInfo::default()
            .viewport_count(1)
            .scissor_count(1);
        let rasterization = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
        let samples = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let attachments = [vk::PipelineColorBlendAttachmentState::default()
            .blend_enable(true)
            .src_color_blend_factor(vk::BlendFactor::ONE)
            .dst_color_blend_factor(vk::BlendFactor::ONE_MINUS_SRC_ALPHA)
            .src_alpha_blend_factor(vk::BlendFactor::ONE)
            .dst_alpha_blend_factor(vk::BlendFactor::ONE_MINUS_SRC_ALPHA)
            .color_write_mask(vk::ColorComponentFlags::RGBA)];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&attachments);
        let depth = vk::PipelineDepthStencilStateCreateInfo::default();
        let dynamic = vk::PipelineDynamicStateCreateInfo::default()
            .dynamic_states(&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR]);
        let formats = [vk::Format::R32G32B32A32_SFLOAT];
        let mut rendering =
            vk::PipelineRenderingCreateInfo::default().color_attachment_formats(&formats);
        let info = vk::GraphicsPipelineCreateInfo::default()
            .flags(vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR)
            .stages(stages)
            .vertex_input_state(&vertex_input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&rasterization)
            .multisample_state(&samples)
            .color_blend_state(&blend)
            .depth_stencil_state(&depth)
            .dynamic_state(&dynamic)
            .layout(self.layout)
            .push_next(&mut rendering);
        // SAFETY: modules and layout are of the same shaders.
        let made =
            unsafe { device.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None) };
        made.map(|made| made[0]).map_err(|(_, result)| result)
    }

    fn destroy(self, device: &ash::Device) {
        // SAFETY: null handles are allowed; nothing is submitted on this device.
        unsafe {
            device.destroy_pipeline(self.pipeline, None);
            device.destroy_pipeline_layout(self.layout, None);
            device.destroy_descriptor_set_layout(self.set, None);
            for module in self.modules {
                device.destroy_shader_module(module, None);
            }
        }
    }
}

/// Every binding of the shaders, seen by all of their stages.
fn bindings(codes: &[Code]) -> Vec<vk::DescriptorSetLayoutBinding<'static>> {
    let mut kinds = BTreeMap::new();
    let mut stages = vk::ShaderStageFlags::empty();
    for code in codes {
        stages |= stage_flag(code.shader.stage);
        kinds.extend(
            code.shader
                .bindings
                .iter()
                .map(|slot| (slot.binding, slot.kind)),
        );
    }
    let binding = |(number, kind)| {
        vk::DescriptorSetLayoutBinding::default()
            .binding(number)
            .descriptor_type(match kind {
                BindingKind::Uniform(_) => vk::DescriptorType::UNIFORM_BUFFER_DYNAMIC,
                BindingKind::Storage => vk::DescriptorType::STORAGE_BUFFER,
                BindingKind::Texture => vk::DescriptorType::SAMPLED_IMAGE,
                BindingKind::Sampler => vk::DescriptorType::SAMPLER,
                BindingKind::StorageImage => vk::DescriptorType::STORAGE_IMAGE,
            })
            .descriptor_count(1)
            .stage_flags(stages)
    };
    kinds.into_iter().map(binding).collect()
}

fn stage_flag(stage: Stage) -> vk::ShaderStageFlags {
    match stage {
        Stage::Compute { .. } => vk::ShaderStageFlags::COMPUTE,
        Stage::Vertex => vk::ShaderStageFlags::VERTEX,
        Stage::Fragment => vk::ShaderStageFlags::FRAGMENT,
    }
}

/// What the driver says of the executable of that stage.
fn statistics(
    null: &NullDevice,
    pipeline: vk::Pipeline,
    stage: vk::ShaderStageFlags,
) -> Result<Cost, vk::Result> {
    let of = vk::PipelineInfoKHR::default().pipeline(pipeline);
    // SAFETY: the pipeline is one of this device, made with statistics.
    let found = unsafe { null.properties.get_pipeline_executable_properties(&of) }?;
    let place = found.iter().position(|one| one.stages.contains(stage));
    let place = place.ok_or(vk::Result::ERROR_UNKNOWN)? as u32;
    let of = vk::PipelineExecutableInfoKHR::default()
        .pipeline(pipeline)
        .executable_index(place);
    // SAFETY: the executable was just counted.
    let found = unsafe { null.properties.get_pipeline_executable_statistics(&of) }?;
    let mut cost = Cost::default();
    for one in found {
        let name = one.name_as_c_str().unwrap_or_default().to_string_lossy();
        // SAFETY: RADV's statistics are whole numbers of 64 bits without a sign.
        cost.set(&name, unsafe { one.value.u64 });
    }
    Ok(cost)
}
