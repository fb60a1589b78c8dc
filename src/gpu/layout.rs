//! The bindings that the shaders of one pipeline declare, as Vulkan wants them.

use super::{Error, Gpu, error::within, owned::Own};
use crate::shaders::{BindingKind, BindingSlot, Shader, Stage};
use ash::vk;
use std::{collections::BTreeMap, sync::Arc};

/// The layout of descriptor set 0 and of the pipeline, made of the union of what its shaders declare.
///
/// Pipelines whose shaders declare the same bindings have layouts that Vulkan counts as equal: bindings
/// made for one serve the other.
#[derive(Debug)]
pub struct Layout {
    pipeline: Own<vk::PipelineLayout>,
    set: Own<vk::DescriptorSetLayout>,
    slots: Vec<BindingSlot>,
    name: String,
}

impl Layout {
    /// `name` stands for the shaders in errors.
    pub(crate) fn new(gpu: &Arc<Gpu>, shaders: &[&Shader], name: &str) -> Result<Self, Error> {
        let doing = || format!("make the layout of `{name}`");
        let declared = union(shaders, name)?;
        for shader in shaders {
            check_buffers(gpu, shader)?;
        }
        let bindings: Vec<_> = declared
            .values()
            .map(|&(slot, stages)| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(slot.binding)
                    .descriptor_type(descriptor_type(slot.kind))
                    .descriptor_count(1)
                    .stage_flags(stages)
            })
            .collect();
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        // SAFETY: the device is valid; binding numbers differ, being keys of a map.
        let set = gpu.call(doing, |device| unsafe {
            device.create_descriptor_set_layout(&info, None)
        })?;
        let set = Own::new(gpu, set);
        gpu.name(set.get(), name);
        let sets = [set.get()];
        let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets);
        // SAFETY: the set layout was made on this device.
        let pipeline = gpu.call(doing, |device| unsafe {
            device.create_pipeline_layout(&info, None)
        })?;
        let pipeline = Own::new(gpu, pipeline);
        gpu.name(pipeline.get(), name);
        let slots = declared.into_values().map(|(slot, _)| slot).collect();
        Ok(Self {
            pipeline,
            set,
            slots,
            name: name.into(),
        })
    }

    /// The layout of the pipeline.
    pub fn raw(&self) -> vk::PipelineLayout {
        self.pipeline.get()
    }

    /// The layout of descriptor set 0.
    pub fn set(&self) -> vk::DescriptorSetLayout {
        self.set.get()
    }

    /// What has to be bound, in order of binding number.
    pub fn slots(&self) -> &[BindingSlot] {
        &self.slots
    }

    /// The shaders' name.
    pub fn name(&self) -> &str {
        &self.name
    }
}

/// A stage sees no more storage buffers than the device allows.
fn check_buffers(gpu: &Gpu, shader: &Shader) -> Result<(), Error> {
    let is_storage = |slot: &&BindingSlot| slot.kind == BindingKind::Storage;
    within(
        || format!("make a pipeline of `{}`", shader.name),
        "maxPerStageDescriptorStorageBuffers",
        shader.bindings.iter().filter(is_storage).count() as u64,
        gpu.limits().max_storage_buffers_per_stage.into(),
    )
}

/// Vulkan's word for a kind of binding.
pub(super) fn descriptor_type(kind: BindingKind) -> vk::DescriptorType {
    match kind {
        BindingKind::Uniform(_) => vk::DescriptorType::UNIFORM_BUFFER_DYNAMIC,
        BindingKind::Storage => vk::DescriptorType::STORAGE_BUFFER,
        BindingKind::Texture => vk::DescriptorType::SAMPLED_IMAGE,
        BindingKind::Sampler => vk::DescriptorType::SAMPLER,
        BindingKind::StorageImage => vk::DescriptorType::STORAGE_IMAGE,
    }
}

pub(super) fn stage_flag(stage: Stage) -> vk::ShaderStageFlags {
    match stage {
        Stage::Compute { .. } => vk::ShaderStageFlags::COMPUTE,
        Stage::Vertex => vk::ShaderStageFlags::VERTEX,
        Stage::Fragment => vk::ShaderStageFlags::FRAGMENT,
    }
}

/// Every binding of the shaders with the stages that see it, by number.
fn union(
    shaders: &[&Shader],
    name: &str,
) -> Result<BTreeMap<u32, (BindingSlot, vk::ShaderStageFlags)>, Error> {
    let mut declared = BTreeMap::new();
    for shader in shaders {
        for &slot in shader.bindings {
            let (first, stages) = declared
                .entry(slot.binding)
                .or_insert((slot, vk::ShaderStageFlags::empty()));
            if *first != slot {
                let problem = format!(
                    "binding {} is `{}` ({:?}) in one stage and `{}` ({:?}) in another",
                    slot.binding, first.name, first.kind, slot.name, slot.kind
                );
                return Err(Error::Binding {
                    shader: name.into(),
                    problem,
                });
            }
            *stages |= stage_flag(shader.stage);
        }
    }
    Ok(declared)
}
