//! Functions of value and gradient: where they are at home, and the one that fits itself to a volume.

use super::Error;
use crate::{
    technique::Mode,
    transfer::{JointCounts, TransferFunction, boundaries},
    volume::{JointHistogram, Volume},
};
use glam::DVec3;

/// A projected value has no gradient.
pub fn refuse_gradients_in(mode: Mode) -> Result<(), Error> {
    if !mode.is_projection() {
        return Ok(());
    }
    Err(Error::usage(
        "widgets and gradient opacity need --mode composite: a projected value has no gradient",
        "leave out --mode, or take a function of the value alone",
    ))
}

/// What preset `boundaries` is for a volume; `None` where no boundary is found.
pub fn boundaries_of(volume: &Volume) -> Option<TransferFunction> {
    let joint = JointHistogram::of(volume, 256, 192);
    let [x, y, z] = volume.dims.map(f64::from);
    let diagonal = volume
        .world_from_voxel
        .transform_vector3(DVec3::new(x, y, z));
    let length = diagonal.length() / 512.0;
    let counts = JointCounts {
        value_range: joint.value_range,
        steepest: joint.gradient_range[1],
        smallest_spacing: volume.grid().smallest_spacing(),
        columns: joint.columns,
        counts: &joint.counts,
    };
    boundaries(
        &counts,
        (length > 0.0 && length.is_finite()).then_some(length),
    )
}
