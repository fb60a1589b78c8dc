//! What a file says of its values, and what they look like.

use crate::transfer::{Context, Quantity, ValueSummary};
use crate::volume::{Header, Volume, VoxelType, Voxels};
use glam::DVec3;

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
        is_cloud: false,
    }
}

/// Whether values are amounts of the water and ice of clouds, or how much of the air they fill: by the standard name or the
/// description.
pub fn is_cloud(header: &Header) -> bool {
    let said = header.standard_name.iter().chain(&header.long_name);
    let names_clouds = said
        .into_iter()
        .any(|text| text.to_lowercase().contains("cloud"));
    let amounts = [
        "kg kg-1",
        "kg/kg",
        "kg kg**-1",
        "g kg-1",
        "g/kg",
        "kg m-3",
        "g m-3",
        "1",
        "%",
        "(0 - 1)",
    ];
    let unit = header.unit.as_deref().unwrap_or("1").trim();
    names_clouds && header.dims[2] > 1 && amounts.contains(&unit)
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

/// Variables of weather models that say where the levels lie: geopotential of WRF, its base state and perturbation.
const PLACES: [&str; 2] = ["PH", "PHB"];

/// The first of several variables that says more than where voxels lie, or the first of all; `None` where there is none.
pub fn first_variable(names: &[String]) -> Option<&String> {
    let is_place = |name: &&String| PLACES.contains(&name.as_str());
    names.iter().find(|name| !is_place(name)).or(names.first())
}
