//! Push constants up to their limit: all at once, piece by piece, changed between two dispatches.

use super::kit;
use super::raw::refused;
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::need::Want;
use crate::conformance::stand::Stand;
use crate::gpu::owned::Own;
use crate::gpu::pipeline::{first, module, stage};
use crate::gpu::{Bindings, Gpu, Layout, Resource};
use crate::shaders::shader;
use ash::vk;
use std::sync::Arc;

const DERIVATION: &str = "Vulkan specification, push constant updates: each dispatch sees the bytes that were pushed last before it was \
recorded, piece by piece, and those that were not pushed again stay. Whole numbers, exact.";

/// Of the size that every device has, and of twice that.
pub fn cases() -> Vec<Case> {
    let case = |bytes: u32| {
        let name = format!("probe.push_constants.{bytes}");
        let case = Case::new(name, move |stand| measure(stand, bytes));
        case.wanting(Want::PushConstants(bytes))
    };
    [128, 256].map(case).into()
}

/// Dispatches, with other pieces pushed before each.
const TURNS: usize = 24;

fn measure(stand: &mut Stand, bytes: u32) -> Result<Measurement, Stop> {
    let words = bytes as usize / 4;
    let mut random = stand.random("push");
    // What is pushed before each dispatch: first all, then a piece.
    let mut pieces = vec![(0, (0..words).map(|_| random.bits() as u32).collect())];
    for _ in 1..TURNS {
        let begin = random.below(words as u32) as usize;
        let count = 1 + random.below((words - begin) as u32) as usize;
        let piece: Vec<u32> = (0..count).map(|_| random.bits() as u32).collect();
        pieces.push((begin, piece));
    }
    let device = stand.device()?;
    let gpu = Arc::clone(device.gpu());
    let made = Made::new(&gpu, bytes)?;
    let mut founds = Vec::new();
    for _ in 0..TURNS {
        let found = kit::zeros::<u32>(&gpu, words, "found")?;
        let given = [("found", Resource::Storage(&found))];
        let bindings = Bindings::new(&gpu, &made.layout, &given)?;
        founds.push((found, bindings));
    }
    device.run(|cmd| {
        let raw = gpu.device();
        let point = vk::PipelineBindPoint::COMPUTE;
        let compute = vk::ShaderStageFlags::COMPUTE;
        let layout = made.pushed.get();
        // SAFETY: recorded outside rendering; ranges lie in the layout's; `run` waits, and all lives meanwhile.
        unsafe {
            raw.cmd_bind_pipeline(cmd, point, made.pipeline.get());
            for ((begin, piece), (_, bindings)) in pieces.iter().zip(&founds) {
                let offset = 4 * *begin as u32;
                raw.cmd_push_constants(cmd, layout, compute, offset, bytemuck::cast_slice(piece));
                let sets = [bindings.raw()];
                raw.cmd_bind_descriptor_sets(cmd, point, layout, 0, &sets, &[]);
                raw.cmd_dispatch(cmd, 1, 1, 1);
            }
        }
        Ok(())
    })?;
    let bound = Bound::new("push-constants", DERIVATION).with("bytes", bytes.into());
    let mut measurement = Measurement::new(bound, TURNS * words);
    let mut wanted = vec![0; words];
    for (turn, ((begin, piece), (found, _))) in pieces.iter().zip(&founds).enumerate() {
        wanted[*begin..*begin + piece.len()].copy_from_slice(piece);
        let found: Vec<u32> = kit::read(found)?;
        for (i, (&wanted, found)) in wanted.iter().zip(found).enumerate() {
            let at = || format!("word {i} of dispatch {turn}");
            measurement.take(at, wanted.into(), found.into(), 0.0);
        }
    }
    Ok(measurement)
}

/// A compute pipeline whose layout has push constants.
struct Made {
    pipeline: Own<vk::Pipeline>,
    pushed: Own<vk::PipelineLayout>,
    layout: Layout,
}

impl Made {
    fn new(gpu: &Arc<Gpu>, bytes: u32) -> Result<Self, Stop> {
        let shader = shader(&format!("probe/push.{bytes}"));
        let layout = Layout::new(gpu, &[shader], shader.name)?;
        let module = module(gpu, shader)?;
        let sets = [layout.set()];
        let ranges = [vk::PushConstantRange::default()
            .stage_flags(vk::ShaderStageFlags::COMPUTE)
            .size(bytes)];
        let info = vk::PipelineLayoutCreateInfo::default()
            .set_layouts(&sets)
            .push_constant_ranges(&ranges);
        // SAFETY: the set's layout was made on this device, and the size is a need of the case.
        let pushed = unsafe { gpu.device().create_pipeline_layout(&info, None) };
        let pushed = Own::new(gpu, pushed.map_err(refused("make a layout"))?);
        let info = vk::ComputePipelineCreateInfo::default()
            .stage(stage(shader, &module))
            .layout(pushed.get());
        let doing = || format!("make compute pipeline `{}`", shader.name);
        // SAFETY: module and layout were made of the same shader.
        let pipeline = first(gpu, doing, |device| unsafe {
            device.create_compute_pipelines(vk::PipelineCache::null(), &[info], None)
        })?;
        Ok(Self {
            pipeline,
            pushed,
            layout,
        })
    }
}
