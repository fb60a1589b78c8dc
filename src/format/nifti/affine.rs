//! Where voxels lie in the world, RAS+ in millimetres: nifti1.h, "3D IMAGE (VOLUME) ORIENTATION AND LOCATION IN SPACE".
//!
//! The first of these that is there and spans a volume counts; i is the index of a voxel:
//!
//! ```text
//! sform_code > 0:   world = S (i, 1)
//! qform_code > 0:   world = R(b, c, d) (i * pixdim * (1, 1, qfac)) + qoffset
//! otherwise:        world = i * pixdim
//! ```

#![allow(
    clippy::arithmetic_side_effects,
    reason = "vectors of f64: nothing wraps or panics"
)]

use super::NIFTI;
use super::fields::Fields;
use crate::format::geometry::world_from_voxel;
use crate::format::problem::invalid;
use crate::volume::Problem;
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// Voxel space to world, and whether the file says how it lies in a patient; what a person should know about it goes
/// to `notes`.
pub(super) fn affine(
    fields: &Fields,
    notes: &mut Vec<String>,
) -> Result<(DAffine3, bool), Problem> {
    let (millimetres, unit_note) = unit(fields);
    notes.extend(unit_note);
    let scaled = |columns: [DVec3; 3], first_center: DVec3| {
        let columns = columns.map(|column| column * millimetres);
        world_from_voxel(columns, first_center * millimetres)
    };
    if fields.sform_code > 0 {
        let column = |k: usize| DVec3::from_array(fields.srow.map(|row| at(&row, k)));
        if let Some(affine) = scaled([column(0), column(1), column(2)], column(3)) {
            let [_, x, y, z, ..] = fields.pixdim;
            if ![x, y, z].iter().all(|&size| is_length(size)) {
                notes.push(format!(
                    "pixdim gives voxels of {x} x {y} x {z}, which cannot be: the sform counts"
                ));
            }
            return Ok((affine, true));
        }
        notes.push("the sform spans no volume and is not used".to_owned());
    }
    let sizes = voxel_sizes(fields, notes);
    if fields.qform_code > 0 {
        let given = at(&fields.pixdim, 0);
        let qfac = if given < 0.0 { -1.0 } else { 1.0 };
        if !given.is_finite() {
            notes.push(format!("qfac, pixdim[0], is {given}: {qfac} is taken"));
        }
        let steps =
            rotation(fields.quatern) * DMat3::from_diagonal(sizes * DVec3::new(1.0, 1.0, qfac));
        let columns = [steps.x_axis, steps.y_axis, steps.z_axis];
        if let Some(affine) = scaled(columns, DVec3::from_array(fields.qoffset)) {
            return Ok((affine, true));
        }
        notes.push("the qform spans no volume and is not used".to_owned());
    }
    notes.push(
        "the file gives no orientation: the axes are taken as right, anterior, superior".to_owned(),
    );
    let columns = DMat3::from_diagonal(sizes);
    scaled(
        [columns.x_axis, columns.y_axis, columns.z_axis],
        DVec3::ZERO,
    )
    .map(|affine| (affine, false))
    .ok_or_else(|| {
        let found = format!("{} {} {}", sizes.x, sizes.y, sizes.z);
        invalid(NIFTI, "pixdim", "lengths that span a volume", &found)
    })
}

/// The unit of space in millimetres, and a note where that is not 1.
fn unit(fields: &Fields) -> (f64, Option<String>) {
    // Bits 0 to 2 are the unit of space.
    match fields.xyzt_units & 7 {
        // Unknown is common and means millimetres in practice.
        0 | 2 => (1.0, None),
        1 => (
            1e3,
            Some("lengths are in metres and converted to millimetres".to_owned()),
        ),
        3 => (
            1e-3,
            Some("lengths are in micrometres and converted to millimetres".to_owned()),
        ),
        other => (
            1.0,
            Some(format!(
                "unit of space {other} is not known: millimetres are taken"
            )),
        ),
    }
}

/// The lengths of the sides of a voxel: no signs, and 1 where the file gives none.
fn voxel_sizes(fields: &Fields, notes: &mut Vec<String>) -> DVec3 {
    let given = [1, 2, 3].map(|k| at(&fields.pixdim, k));
    let sizes = given.map(|size| if is_length(size) { size.abs() } else { 1.0 });
    if sizes != given {
        notes.push(format!(
            "voxels of {} x {} x {} are taken as {} x {} x {}",
            given[0], given[1], given[2], sizes[0], sizes[1], sizes[2]
        ));
    }
    DVec3::from_array(sizes)
}

/// True for what the length of a side may be; a sign does not matter.
fn is_length(size: f64) -> bool {
    size.is_finite() && size != 0.0
}

/// The rotation of a unit quaternion a + bi + cj + dk with a = sqrt(1 - b^2 - c^2 - d^2).
///
/// A half turn has a = 0, which rounding makes imaginary: then b, c, d are made one long.
fn rotation([b, c, d]: [f64; 3]) -> DMat3 {
    let vector = DVec3::new(b, c, d);
    let squared = 1.0 - vector.length_squared();
    let quaternion = if squared < 1e-7 {
        let axis = vector.normalize_or_zero();
        DQuat::from_xyzw(axis.x, axis.y, axis.z, 0.0)
    } else {
        DQuat::from_xyzw(b, c, d, squared.sqrt())
    };
    DMat3::from_quat(quaternion)
}

fn at<const N: usize>(numbers: &[f64; N], k: usize) -> f64 {
    numbers.get(k).copied().unwrap_or(0.0)
}
