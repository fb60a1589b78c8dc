//! The light volume of a scene, made on the device.

use super::Error;
use super::time_slices::{TimeSlices, Work};
use crate::gpu::Headless;
use crate::resident::GpuTransfer;
use crate::scene::Scene;
use crate::technique::cost::ms_of_fetches;
use crate::technique::{
    ClipPlane, Filter, GpuChannel, GradientFilter, Inputs, LightPlan, LightVolume, Mode, Recording,
    Role, SampleInputs, Skip, View, parameter_ring,
};
use crate::transfer::TransferFunction;
use crate::volume::Volume;
use glam::DVec3;
use std::sync::Arc;

/// A number from a buffer and a multiplication.
const LOOKS_OF_A_PIECE: f64 = 0.1;

/// What light is followed through.
#[derive(Clone, Debug, PartialEq)]
pub struct Matter {
    functions: Vec<TransferFunction>,
    roles: Vec<Role>,
    dim: f64,
    filter: Filter,
    gradient_filter: GradientFilter,
    crop: Option<[DVec3; 2]>,
    clip_planes: Vec<ClipPlane>,
    density: f64,
    scatters: bool,
}

impl Matter {
    /// That of a scene, by the functions that classify it.
    pub fn of(scene: &Scene, functions: &[&TransferFunction]) -> Self {
        let settings = scene.settings;
        Self {
            functions: functions.iter().copied().cloned().collect(),
            roles: scene.roles(),
            dim: settings.dim,
            filter: settings.filter,
            gradient_filter: settings.gradient_filter,
            crop: settings.crop,
            clip_planes: settings.clip_planes.clone(),
            density: settings.density_of_rays(),
            scatters: settings.scatters(),
        }
    }
}

/// The light volume of a scene in such a view; `None` where its picture reads none.
pub fn light_plan_of(
    scene: &Scene,
    view: &View,
) -> Result<Option<LightPlan>, crate::technique::Error> {
    let mut plan = view.light_plan()?;
    if let Some(plan) = &mut plan {
        for volume in matter_volumes(scene) {
            plan.look_at(view.grid, &volume.grid());
        }
    }
    Ok(plan)
}

/// The volumes that are in the way of light: all that are seen together, but what colours surfaces.
pub fn matter_volumes<'a>(scene: &Scene<'a>) -> Vec<&'a Volume> {
    match scene.settings.mode {
        Mode::Iso => vec![scene.volume],
        _ => scene.volumes(),
    }
}

/// How many volumes they are on the device, where voxels that are classified are four.
pub fn matter_count(scene: &Scene) -> usize {
    match scene.settings.mode {
        Mode::Iso => 1,
        _ => scene.roles().len(),
    }
}

/// Makes it of these volumes of the scene, and waits for it.
pub fn made_light(
    device: &mut Headless,
    slices: &mut TimeSlices,
    scene: &Scene,
    plan: LightPlan,
    parts: &[GpuChannel],
    transfer: Option<&GpuTransfer>,
) -> Result<LightVolume, Error> {
    let gpu = Arc::clone(device.gpu());
    let mix = match parts {
        [_] => SampleInputs::Scalar,
        _ => scene.mix(),
    };
    let grid = scene.volume.grid();
    let recordings = scene.view(&grid, [0.0; 2]).recordings_of(parts, transfer)?;
    let volume = parts[0].volume;
    let light = LightVolume::mixed(&gpu, plan, scene.settings, mix, parts)?;
    let ring = parameter_ring(&gpu, recordings.len() as u32)?;
    let one = |(slot, recording): (u32, &Recording)| {
        let others = parts[1..].iter();
        let beside: Vec<_> = others
            .map(|part| &part.volume.bricks()[recording.brick])
            .collect();
        let inputs = Inputs {
            ring: &ring,
            volume,
            brick: &volume.bricks()[recording.brick],
            transfer,
            beside: &beside,
            light: None,
            points: None,
            field: None,
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
    let of_cells =
        plan.cell_count() as f64 * f64::from(of_cell) * (bound.len() * parts.len()) as f64;
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
