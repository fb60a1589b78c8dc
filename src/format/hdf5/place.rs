//! Where the voxels of a data set lie: attributes that programs agree on, as HDF5 has none of its own.
//!
//! `element_size_um` (ilastik, Fiji's HDF5 plug-in, Voreen) is the size of a voxel along z, y, x in micrometres,
//! and `offset_um` (Voreen) the place of the first one; `physical_to_world_transformation` (Voreen) are the 16
//! numbers, row by row, of what comes after. Otherwise `spacing` (or `resolution`) and `origin` (or `offset`),
//! along z, y, x too, in the file's own unit.

use super::HDF5;
use crate::format::cf::Variable;
use crate::format::geometry::{is_invertible, world_from_voxel};
use crate::format::problem::invalid;
use crate::volume::Problem;
use glam::{DAffine3, DMat4, DVec3};

/// The affine, and what a person should know about it.
#[allow(
    clippy::arithmetic_side_effects,
    reason = "vectors of f64: nothing wraps or panics"
)]
pub(super) fn place(variable: &Variable) -> Result<(DAffine3, Vec<String>), Problem> {
    let attributes = &variable.attributes;
    let xyz = |name: &str| match attributes.numbers(name) {
        Some(&[z, y, x]) => Some(DVec3::new(x, y, z)),
        _ => None,
    };
    let mut notes = Vec::new();
    let in_micrometers = xyz("element_size_um");
    let (name, spacing, origin) = match in_micrometers {
        Some(spacing) => {
            notes.push("the world is in millimetres".to_owned());
            let origin = xyz("offset_um").unwrap_or(DVec3::ZERO);
            ("element_size_um", spacing / 1000.0, origin / 1000.0)
        }
        None => {
            let named = ["spacing", "resolution"]
                .into_iter()
                .find_map(|name| Some((name, xyz(name)?)));
            let (name, spacing) = named.unwrap_or_else(|| {
                notes.push("the file gives no spacing: 1 is taken".to_owned());
                ("spacing", DVec3::ONE)
            });
            let origin = xyz("origin").or_else(|| xyz("offset"));
            (name, spacing, origin.unwrap_or(DVec3::ZERO))
        }
    };
    let columns = [
        DVec3::X * spacing.x,
        DVec3::Y * spacing.y,
        DVec3::Z * spacing.z,
    ];
    let sound = world_from_voxel(columns, origin).ok_or_else(|| {
        let found = format!("{} {} {}", spacing.z, spacing.y, spacing.x);
        invalid(HDF5, name, "three lengths above 0", &found)
    })?;
    let after = attributes
        .numbers("physical_to_world_transformation")
        .and_then(|rows| <&[f64; 16]>::try_from(rows).ok())
        .map(|rows| DMat4::from_cols_array(rows).transpose());
    let Some(after) = after else {
        return Ok((sound, notes));
    };
    let is_affine = after.row(3).to_array() == [0.0, 0.0, 0.0, 1.0];
    let whole = DAffine3::from_mat4(after) * sound;
    if is_affine && is_invertible(&whole) {
        return Ok((whole, notes));
    }
    notes.push(
        "physical_to_world_transformation is no affine that can be inverted: it is left out"
            .to_owned(),
    );
    Ok((sound, notes))
}
