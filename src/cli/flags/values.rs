//! What flags of colour ask of names and of volumes.

use crate::{
    transfer::{Colormap, Context, Preset, Quantity, ValueSummary},
    volume::{Header, Volume, VoxelType, Voxels},
};
use glam::DVec3;

/// A sentence with all its causes.
pub fn with_causes(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        text = format!("{text}: {error}");
        cause = error.source();
    }
    text
}

pub fn preset(name: &str) -> Result<String, String> {
    let names = Preset::ALL.map(Preset::name);
    if names.contains(&name) {
        Ok(name.to_owned())
    } else {
        Err(format!(
            "no preset {name:?}; there are {}",
            names.join(", ")
        ))
    }
}

/// A word of `--colormap` that is right.
pub fn colormap(text: &str) -> Result<String, String> {
    text.parse().map(|map: Colormap| map.to_string())
}

/// What the file says of its values, beside the values.
pub fn context(header: &Header) -> Context {
    Context {
        unit: header.unit.clone(),
        standard_name: header.standard_name.clone(),
        modality: header.modality.clone(),
        is_patient: header.is_patient,
        is_integer: !matches!(
            header.stored,
            VoxelType::F16 | VoxelType::F32 | VoxelType::F64
        ),
    }
}

/// What the values of a volume look like as a whole. Looks at millions of voxels, so each type has a loop of its own.
pub fn summary(volume: &Volume) -> ValueSummary {
    match &volume.voxels {
        Voxels::U8(v) => summary_of(volume, |i| v[i].into()),
        Voxels::I8(v) => summary_of(volume, |i| v[i].into()),
        Voxels::U16(v) => summary_of(volume, |i| v[i].into()),
        Voxels::I16(v) => summary_of(volume, |i| v[i].into()),
        Voxels::F16(v) => summary_of(volume, |i| v[i].to_f64()),
        Voxels::F32(v) => summary_of(volume, |i| v[i].into()),
    }
}

fn summary_of(volume: &Volume, stored: impl Fn(usize) -> f64) -> ValueSummary {
    let [x, y, z] = volume.dims.map(f64::from);
    let diagonal = volume
        .world_from_voxel
        .transform_vector3(DVec3::new(x, y, z));
    let validity = volume.validity.as_deref();
    let is_valid = |i: usize| validity.is_none_or(|valid| valid[i] != 0);
    let value = |i: usize| stored(i) * volume.rescale.slope + volume.rescale.intercept;
    ValueSummary::of(
        volume.voxels.len(),
        volume.value_range,
        diagonal.length(),
        volume.hounsfield,
        |i| is_valid(i).then(|| value(i)),
    )
    .measuring(Quantity::of_unit(volume.unit.as_deref()))
}
