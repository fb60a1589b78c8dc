//! A compute pipeline, and what every pipeline shares.

use super::{
    Bindings, Error, Gpu, Layout, error::Doing, error::within, layout::stage_flag, owned::Own,
};
use crate::shaders::{Shader, Stage};
use ash::vk;
use std::sync::{Arc, atomic::Ordering};

/// One compute shader, ready to be dispatched.
#[derive(Debug)]
pub struct ComputePipeline {
    raw: Own<vk::Pipeline>,
    layout: Layout,
    workgroup: [u32; 3],
}

impl ComputePipeline {
    /// Compiles `shader`, after its workgroup was compared with the limits.
    pub fn new(gpu: &Arc<Gpu>, shader: &Shader) -> Result<Self, Error> {
        let doing = || format!("make compute pipeline `{}`", shader.name);
        let Stage::Compute { workgroup } = shader.stage else {
            return Err(wrong_stage(doing(), "a compute shader", shader));
        };
        let limits = gpu.limits();
        let names = [
            "maxComputeWorkGroupSize.x",
            "maxComputeWorkGroupSize.y",
            "maxComputeWorkGroupSize.z",
        ];
        for k in 0..3 {
            within(
                doing,
                names[k],
                workgroup[k].into(),
                limits.max_workgroup_size[k].into(),
            )?;
        }
        let invocations = workgroup
            .iter()
            .fold(1, |product: u64, &n| product.saturating_mul(n.into()));
        let allowed = limits.max_workgroup_invocations.into();
        within(
            doing,
            "maxComputeWorkGroupInvocations",
            invocations,
            allowed,
        )?;
        let layout = Layout::new(gpu, &[shader], shader.name)?;
        let module = module(gpu, shader)?;
        let info = vk::ComputePipelineCreateInfo::default()
            .stage(stage(shader, &module))
            .layout(layout.raw());
        // SAFETY: module and layout were made of the same shader, whose SPIR-V `build.rs` has validated.
        let made = unsafe {
            gpu.device()
                .create_compute_pipelines(gpu.pipeline_cache, &[info], None)
        };
        let raw = first(gpu, made, doing)?;
        gpu.name(raw.get(), shader.name);
        Ok(Self {
            raw,
            layout,
            workgroup,
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

    /// Workgroups that cover `threads` invocations.
    pub fn groups(&self, threads: [u32; 3]) -> Result<[u32; 3], Error> {
        let doing = || format!("dispatch `{}` over {threads:?} threads", self.layout.name());
        let groups = std::array::from_fn(|k| threads[k].div_ceil(self.workgroup[k]));
        let names = [
            "maxComputeWorkGroupCount.x",
            "maxComputeWorkGroupCount.y",
            "maxComputeWorkGroupCount.z",
        ];
        let allowed = self.raw.gpu().limits().max_workgroup_count;
        for k in 0..3 {
            within(doing, names[k], groups[k].into(), allowed[k].into())?;
        }
        Ok(groups)
    }

    /// Binds pipeline and bindings and dispatches `groups` ([`ComputePipeline::groups`]).
    ///
    /// `offsets` are the dynamic offsets ([`super::ParameterRing::offset`]) of the uniform bindings, in order of
    /// their numbers.
    ///
    /// # Safety
    ///
    /// - `cmd` is recording on our device, outside rendering;
    /// - `bindings` were made for an equal layout; pipeline, bindings and what is bound live until `cmd` has run;
    /// - there is one offset a uniform binding.
    pub unsafe fn dispatch(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &Bindings,
        offsets: &[u32],
        groups: [u32; 3],
    ) {
        let device = self.raw.gpu().device();
        let point = vk::PipelineBindPoint::COMPUTE;
        let sets = [bindings.raw()];
        // SAFETY: the caller's promises are all that these calls ask.
        unsafe {
            device.cmd_bind_pipeline(cmd, point, self.raw());
            device.cmd_bind_descriptor_sets(cmd, point, self.layout.raw(), 0, &sets, offsets);
            device.cmd_dispatch(cmd, groups[0], groups[1], groups[2]);
        }
    }
}

/// A stage of the wrong kind where another was wanted.
pub(super) fn wrong_stage(doing: String, wanted: &str, shader: &Shader) -> Error {
    let found = format!("`{}`, which is {:?}", shader.name, shader.stage);
    Error::Argument {
        doing,
        wanted: wanted.into(),
        found,
    }
}

/// The SPIR-V of a shader on the device; needed only until its pipeline is made.
pub(super) fn module(gpu: &Arc<Gpu>, shader: &Shader) -> Result<Own<vk::ShaderModule>, Error> {
    let info = vk::ShaderModuleCreateInfo::default().code(shader.spirv);
    // SAFETY: the SPIR-V was validated when it was built.
    let raw = unsafe { gpu.device().create_shader_module(&info, None) }
        .doing(|| format!("load shader `{}`", shader.name))?;
    gpu.name(raw, shader.name);
    Ok(Own::new(gpu, raw))
}

pub(super) fn stage<'a>(
    shader: &Shader,
    module: &Own<vk::ShaderModule>,
) -> vk::PipelineShaderStageCreateInfo<'a> {
    vk::PipelineShaderStageCreateInfo::default()
        .stage(stage_flag(shader.stage))
        .module(module.get())
        .name(c"main")
}

/// The one pipeline that was asked for.
pub(super) fn first(
    gpu: &Arc<Gpu>,
    made: Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>,
    doing: impl FnOnce() -> String,
) -> Result<Own<vk::Pipeline>, Error> {
    // On failure Vulkan leaves null handles behind.
    let raw = made.map_err(|(_, result)| result).doing(doing)?;
    gpu.pipelines_made.fetch_add(1, Ordering::Relaxed);
    Ok(Own::new(gpu, raw[0]))
}
