//! The light volume of a scene, made on the device.

use super::Error;
use super::time_slices::{TimeSlices, Work};
use crate::gpu::Headless;
use crate::resident::GpuTransfer;
use crate::scene::Scene;
use crate::technique::cost::ms_of_fetches;
use crate::technique::{
    ClipPlane, Filter, GpuChannel, GradientFilter, Inputs, LightPlan, LightVolume, Skip,
    parameter_ring,
};
use crate::transfer::TransferFunction;
use glam::DVec3;
use std::sync::Arc;

/// A number from a buffer and a multiplication.
const LOOKS_OF_A_PIECE: f64 = 0.1;

/// What light is followed through, of one volume.
#[derive(Clone, Debug, PartialEq)]
pub struct Matter {
    function: TransferFunction,
    filter: Filter,
    gradient_filter: GradientFilter,
    crop: Option<[DVec3; 2]>,
    clip_planes: Vec<ClipPlane>,
}

impl Matter {
    /// That of a scene, by the function that classifies it.
    pub fn of(scene: &Scene, function: &TransferFunction) -> Self {
        let settings = scene.settings;
        Self {
            function: function.clone(),
            filter: settings.filter,
            gradient_filter: settings.gradient_filter,
            crop: settings.crop,
            clip_planes: settings.clip_planes.clone(),
        }
    }
}

/// Makes it and waits for it.
pub fn made_light(
    device: &mut Headless,
    slices: &mut TimeSlices,
    scene: &Scene,
    plan: LightPlan,
    parts: &[GpuChannel],
    transfer: Option<&GpuTransfer>,
) -> Result<LightVolume, Error> {
    let gpu = Arc::clone(device.gpu());
    let grid = scene.volume.grid();
    let recordings = scene.view(&grid, [0.0; 2]).recordings_of(parts, transfer)?;
    let volume = parts[0].volume;
    let light = LightVolume::new(&gpu, plan, scene.settings, volume)?;
    let ring = parameter_ring(&gpu, recordings.len() as u32)?;
    let one = |(slot, recording): (u32, &crate::technique::Recording)| {
        let inputs = Inputs {
            ring: &ring,
            volume,
            brick: &volume.bricks()[recording.brick],
            transfer,
            beside: &[],
            light: None,
            points: None,
            sky: None,
            skip: Skip::Nothing,
        };
        Ok((light.bind(&inputs)?, recording.write(&ring, slot)?))
    };
    let bound = (0..).zip(&recordings).map(one);
    let bound = bound.collect::<Result<Vec<_>, Error>>()?;
    let bricks = || bound.iter().map(|(bindings, offset)| (bindings, *offset));
    let plan = light.plan();
    let of_cell: u32 = plan.looks.iter().product();
    let of_cells = plan.cell_count() as f64 * f64::from(of_cell) * bound.len() as f64;
    // Pieces of paths, of which most end where nothing comes through or outside.
    let of_node = LOOKS_OF_A_PIECE * plan.paths.len() as f64 / f64::from(plan.bundle_count.max(1));
    let of_nodes = plan.node_count() as f64 * of_node;
    let runs = light.group_runs(bound.len())?;
    for (run, fetches) in runs.into_iter().zip([of_cells, of_nodes]) {
        let work = Work::beside(run, ms_of_fetches(&gpu, fetches));
        slices.run(device, None, work, |cmd, _, part| {
            // SAFETY: recorded outside rendering, parts in order; `run` waits, and all that is bound lives meanwhile.
            unsafe { light.record_part(cmd, bricks(), part) }
        })?;
    }
    Ok(light)
}
