//! A compute pipeline, and what every pipeline shares.

#[cfg(feature = "conformance")]
use super::recorder;
use super::{
    Bindings, Buffer, Error, Gpu, Groups, Layout, Tile, boxes, error::within, layout::stage_flag,
    owned::Own, pipelines::Key, pipelines::Pipeline,
};
use crate::shaders::{Shader, Stage};
use ash::vk;
use std::ops::Range;
use std::sync::{Arc, atomic::Ordering};

/// One compute shader, ready to be dispatched.
#[derive(Debug)]
pub struct ComputePipeline {
    raw: Pipeline,
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
        let key = Key {
            shaders: vec![*shader],
            raster: None,
        };
        let raw = Pipeline::new(gpu, key, shader.name, || {
            let module = module(gpu, shader)?;
            let info = vk::ComputePipelineCreateInfo::default()
                // Parts of a dispatch begin at workgroups of their own.
                .flags(vk::PipelineCreateFlags::DISPATCH_BASE)
                .stage(stage(shader, &module))
                .layout(layout.raw());
            // SAFETY: module and layout were made of the same shader, whose SPIR-V `build.rs` has validated.
            first(gpu, doing, |device| unsafe {
                device.create_compute_pipelines(gpu.pipeline_cache, &[info], None)
            })
        })?;
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

    /// Workgroups that have the threads of a box, from its first to before its end: neighbours too.
    pub(crate) fn groups_around(&self, first: [u32; 3], end: [u32; 3]) -> Groups {
        let base = std::array::from_fn(|k| first[k] / self.workgroup[k]);
        Groups {
            base,
            count: std::array::from_fn(|k| end[k].div_ceil(self.workgroup[k]) - base[k]),
        }
    }

    /// Workgroups of a part of a picture of `extent`, one thread a pixel.
    pub(crate) fn groups_of(&self, extent: [u32; 2], tile: Tile) -> Result<Groups, Error> {
        self.groups([extent[0], extent[1], 1])?;
        let mut groups = Groups {
            base: [0; 3],
            count: [1; 3],
        };
        for k in 0..2 {
            let side = self.workgroup[k];
            let end = tile.origin[k].saturating_add(tile.extent[k]);
            let fits = |at: u32| at.is_multiple_of(side);
            if end > extent[k] || !fits(tile.origin[k]) || !(fits(end) || end == extent[k]) {
                return Err(Error::Argument {
                    doing: format!("dispatch `{}` over a part of a picture", self.layout.name()),
                    wanted: format!(
                        "corners at multiples of {side} pixels, the last at the edge of {extent:?} pixels"
                    ),
                    found: format!("{:?} pixels from {:?}", tile.extent, tile.origin),
                });
            }
            groups.base[k] = tile.origin[k] / side;
            groups.count[k] = end.div_ceil(side) - groups.base[k];
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
        let whole = Groups {
            base: [0; 3],
            count: groups,
        };
        // SAFETY: the caller's promises.
        unsafe { self.dispatch_boxes(cmd, bindings, offsets, [whole]) };
    }

    /// The same for a run of the workgroups of `groups`, counted x fastest, then y, then z: what shaders see of their
    /// place is as in the whole dispatch (`GlobalInvocationId` counts the base).
    ///
    /// # Safety
    ///
    /// As [`ComputePipeline::dispatch`].
    pub(crate) unsafe fn dispatch_run(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &Bindings,
        offsets: &[u32],
        groups: [u32; 3],
        run: Range<u64>,
    ) {
        // SAFETY: the caller's promises; the boxes lie in `groups`.
        unsafe { self.dispatch_boxes(cmd, bindings, offsets, boxes(groups, run)) };
    }

    /// The same for the workgroups of [`ComputePipeline::groups_of`].
    ///
    /// # Safety
    ///
    /// As [`ComputePipeline::dispatch`].
    pub(crate) unsafe fn dispatch_boxes(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &Bindings,
        offsets: &[u32],
        boxes: impl IntoIterator<Item = Groups>,
    ) {
        let point = vk::PipelineBindPoint::COMPUTE;
        let sets = [bindings.raw()];
        // SAFETY: the caller's promises are all that these calls ask; every pipeline is made with `DISPATCH_BASE`.
        self.raw.gpu().record(|device| unsafe {
            device.cmd_bind_pipeline(cmd, point, self.raw());
            device.cmd_bind_descriptor_sets(cmd, point, self.layout.raw(), 0, &sets, offsets);
            for Groups { base, count } in boxes {
                #[cfg(feature = "conformance")]
                recorder::note(recorder::Event::Dispatch {
                    shader: self.layout.name(),
                    base,
                    groups: count,
                });
                let ([x, y, z], [nx, ny, nz]) = (base, count);
                // Validation layers of 2023 look for hazards at `vkCmdDispatch` alone.
                match base {
                    [0, 0, 0] => device.cmd_dispatch(cmd, nx, ny, nz),
                    _ => device.cmd_dispatch_base(cmd, x, y, z, nx, ny, nz),
                }
            }
        });
    }

    /// Binds pipeline and bindings and dispatches as many workgroups as `groups` begins with: a
    /// `VkDispatchIndirectCommand`.
    ///
    /// # Safety
    ///
    /// As [`ComputePipeline::dispatch`]; `groups` has `INDIRECT_BUFFER` usage, is in `Use::DrawIndirect`, and holds
    /// numbers within the limits of [`ComputePipeline::groups`].
    pub(crate) unsafe fn dispatch_indirect(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &Bindings,
        offsets: &[u32],
        groups: &Buffer,
    ) {
        let point = vk::PipelineBindPoint::COMPUTE;
        let sets = [bindings.raw()];
        #[cfg(feature = "conformance")]
        recorder::note(recorder::Event::DispatchIndirect {
            shader: self.layout.name(),
            buffer: groups.name(),
        });
        // SAFETY: the caller's promises are all that these calls ask.
        self.raw.gpu().record(|device| unsafe {
            device.cmd_bind_pipeline(cmd, point, self.raw());
            device.cmd_bind_descriptor_sets(cmd, point, self.layout.raw(), 0, &sets, offsets);
            device.cmd_dispatch_indirect(cmd, groups.raw(), 0);
        });
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

/// The SPIR-V of a shader, as this device gets it.
pub(super) fn words(gpu: &Gpu, shader: &Shader) -> Vec<u32> {
    match gpu.has_slow_conversions() {
        true => shader.without_conversions(),
        false => shader.folded(gpu.is_llvmpipe()),
    }
}

/// The SPIR-V of a shader on the device; needed only until its pipeline is made.
pub(crate) fn module(gpu: &Arc<Gpu>, shader: &Shader) -> Result<Own<vk::ShaderModule>, Error> {
    let words = words(gpu, shader);
    let info = vk::ShaderModuleCreateInfo::default().code(&words);
    // SAFETY: the SPIR-V was validated when it was built.
    let raw = gpu.call(
        || format!("load shader `{}`", shader.name),
        |device| unsafe { device.create_shader_module(&info, None) },
    )?;
    gpu.name(raw, shader.name);
    #[cfg(feature = "conformance")]
    recorder::note(recorder::Event::Shader {
        shader,
        words: &words,
    });
    Ok(Own::new(gpu, raw))
}

pub(crate) fn stage(
    shader: &Shader,
    module: &Own<vk::ShaderModule>,
) -> vk::PipelineShaderStageCreateInfo<'static> {
    vk::PipelineShaderStageCreateInfo::default()
        .stage(stage_flag(shader.stage))
        .module(module.get())
        .name(c"main")
}

/// The one pipeline that was asked for.
pub(crate) fn first(
    gpu: &Arc<Gpu>,
    doing: impl FnOnce() -> String,
    make: impl FnOnce(&ash::Device) -> Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>,
) -> Result<vk::Pipeline, Error> {
    // On failure Vulkan leaves null handles behind.
    let raw = gpu.call(doing, |device| make(device).map_err(|(_, result)| result))?;
    gpu.pipelines_made.fetch_add(1, Ordering::Relaxed);
    Ok(raw[0])
}
