//! The affine of voxel centres, as files give it, to the affine of voxel space.
//!
//! ```text
//! world = first_center + sum of index[k] * column[k],   voxel = index + 0.5
//! ```

#![allow(
    clippy::arithmetic_side_effects,
    reason = "vectors of f64: nothing wraps or panics"
)]

use glam::{DAffine3, DMat3, DVec3};

/// Multiplies LPS coordinates (DICOM, MetaImage) to make RAS+ ones.
pub(crate) const RAS_FROM_LPS: DVec3 = DVec3::new(-1.0, -1.0, 1.0);

/// Lengths outside make products of three overflow or vanish.
const LENGTHS: std::ops::RangeInclusive<f64> = 1e-30..=1e30;

/// Voxel space to world from the steps between voxel centres along x, y, z and the centre of voxel (0, 0, 0).
/// `None` where a number is not finite, a step has no length, or the steps lie in one plane.
pub(crate) fn world_from_voxel(columns: [DVec3; 3], first_center: DVec3) -> Option<DAffine3> {
    let steps = DMat3::from_cols_array_2d(&columns.map(|column| column.to_array()));
    let directions =
        DMat3::from_cols_array_2d(&columns.map(|column| column.normalize_or_zero().to_array()));
    let sound = columns
        .iter()
        .all(|column| LENGTHS.contains(&column.length()))
        && first_center.is_finite()
        && directions.determinant().abs() > 1e-9;
    let corner = first_center - steps * DVec3::splat(0.5);
    sound.then(|| DAffine3::from_mat3_translation(steps, corner))
}

/// Whether points have one place each way: a determinant that is as small as a number can be has an inverse that is
/// none.
pub(crate) fn is_invertible(affine: &DAffine3) -> bool {
    affine.is_finite() && affine.matrix3.determinant().is_normal() && affine.inverse().is_finite()
}

/// Adds steps for the axes that a line or a plane of voxels lacks: at right angles to the others, as long as
/// the shortest of them.
pub(crate) fn with_missing_axes(columns: &[DVec3]) -> [DVec3; 3] {
    let shortest = columns
        .iter()
        .map(|column| column.length())
        .fold(f64::INFINITY, f64::min);
    match *columns {
        [] => [DVec3::X, DVec3::Y, DVec3::Z],
        [x] => {
            let (y, z) = x.normalize_or(DVec3::X).any_orthonormal_pair();
            [x, y * shortest, z * shortest]
        }
        [x, y] => [x, y, x.cross(y).normalize_or_zero() * shortest],
        [x, y, z, ..] => [x, y, z],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_centre_of_the_first_voxel_lies_where_the_file_says() {
        let columns = [
            DVec3::new(0.0, 2.0, 0.5),
            DVec3::new(-3.0, 0.0, 0.0),
            DVec3::new(0.0, 0.0, -4.0),
        ];
        let first_center = DVec3::new(10.0, 20.0, 30.0);
        let affine = world_from_voxel(columns, first_center).unwrap();
        assert_eq!(affine.transform_point3(DVec3::splat(0.5)), first_center);
        let next = affine.transform_point3(DVec3::new(1.5, 0.5, 0.5));
        assert_eq!(next, first_center + columns[0]);
    }

    #[test]
    fn steps_that_span_no_volume_are_refused() {
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z];
        for columns in [
            [x, y, DVec3::ZERO],
            [x, y, x + y],
            [x, y, z * f64::NAN],
            [x, y, z * f64::INFINITY],
            [x, y, z * 1e-200],
        ] {
            assert_eq!(world_from_voxel(columns, DVec3::ZERO), None, "{columns:?}");
        }
        assert_eq!(world_from_voxel([x, y, z], DVec3::splat(f64::NAN)), None);
    }

    #[test]
    fn a_transform_whose_inverse_overflows_is_not_invertible() {
        let affine = |y: f64| {
            let x = DVec3::new(-1.5, 0.0, 0.0);
            let y = DVec3::new(0.0, y, 0.25);
            let matrix = DMat3::from_cols(x, y, DVec3::new(0.0, 0.0, 16.0));
            DAffine3::from_mat3_translation(matrix, DVec3::new(-0.25, 2.75, 1.875))
        };
        assert!(is_invertible(&affine(1.0)));
        // The determinant is as a number should be.
        assert!(affine(1e-308).matrix3.determinant().is_normal());
        assert!(!is_invertible(&affine(1e-308)));
    }

    #[test]
    fn missing_axes_stand_at_right_angles_and_keep_the_shortest_step() {
        let [x, y, z] = with_missing_axes(&[DVec3::new(0.0, 3.0, 0.0), DVec3::new(0.0, 0.0, 2.0)]);
        assert_eq!((x.dot(z), y.dot(z), z.length()), (0.0, 0.0, 2.0));
        let [x, y, z] = with_missing_axes(&[DVec3::new(0.0, 3.0, 0.0)]);
        assert_eq!((x.dot(y), x.dot(z), y.dot(z)), (0.0, 0.0, 0.0));
        assert_eq!((y.length(), z.length()), (3.0, 3.0));
    }
}
