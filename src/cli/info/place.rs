//! How a grid lies in the world, in words.

use crate::volume::{Format, Grid};
use glam::DVec3;

/// Directions of the world towards larger and smaller coordinates, where they have names.
const ANATOMY: [[&str; 2]; 3] = [
    ["right", "left"],
    ["anterior", "posterior"],
    ["superior", "inferior"],
];
const AXES: [[&str; 2]; 3] = [
    ["along +x", "along -x"],
    ["along +y", "along -y"],
    ["along +z", "along -z"],
];
/// An axis that is off by less is not worth a word.
const STRAIGHT_DEGREES: f64 = 0.05;

/// `x right, y anterior, z superior`, each with how far it is off where it is.
pub fn orientation(grid: &Grid, format: Format) -> String {
    let names = match format {
        Format::Nifti1 | Format::Nifti2 | Format::Dicom | Format::MetaImage | Format::Nrrd => {
            ANATOMY
        }
        _ => AXES,
    };
    let columns = columns(grid);
    let words = ["x", "y", "z"].iter().zip(columns).map(|(axis, column)| {
        let along = (0..3).fold(0, |most, k| {
            if column[k].abs() > column[most].abs() {
                k
            } else {
                most
            }
        });
        let name = names[along][usize::from(column[along] < 0.0)];
        let degrees = column[along].abs().min(1.0).acos().to_degrees();
        if degrees < STRAIGHT_DEGREES {
            format!("{axis} {name}")
        } else {
            format!("{axis} {name} (oblique by {degrees:.1} degrees)")
        }
    });
    words.collect::<Vec<_>>().join(", ")
}

/// The pairs of axes that are not at right angles, in words; `None` where all are.
pub fn shear(grid: &Grid) -> Option<String> {
    let columns = columns(grid);
    let pairs = [("x", 0, "y", 1), ("x", 0, "z", 2), ("y", 1, "z", 2)];
    let words = pairs.iter().filter_map(|&(a, i, b, j)| {
        let degrees = columns[i]
            .dot(columns[j])
            .clamp(-1.0, 1.0)
            .acos()
            .to_degrees();
        let is_off = (degrees - 90.0).abs() > STRAIGHT_DEGREES;
        is_off.then(|| format!("{a} and {b} meet at {degrees:.1} degrees"))
    });
    let words: Vec<_> = words.collect();
    (!words.is_empty()).then(|| words.join(", "))
}

/// The unit vectors of the voxel axes.
fn columns(grid: &Grid) -> [DVec3; 3] {
    let m = grid.world_from_voxel.matrix3;
    [m.x_axis, m.y_axis, m.z_axis].map(DVec3::normalize_or_zero)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DAffine3, DMat3};

    fn grid(columns: [[f64; 3]; 3]) -> Grid {
        let matrix = DMat3::from_cols_array_2d(&columns);
        Grid {
            dims: [2; 3],
            world_from_voxel: DAffine3::from_mat3_translation(matrix, DVec3::ZERO),
        }
    }

    #[test]
    fn a_grid_is_named_by_where_its_axes_run() {
        let lps = grid([[-2.0, 0.0, 0.0], [0.0, -2.0, 0.0], [0.0, 0.0, 3.0]]);
        assert_eq!(
            orientation(&lps, Format::Nrrd),
            "x left, y posterior, z superior"
        );
        assert_eq!(
            orientation(&lps, Format::Tiff),
            "x along -x, y along -y, z along +z"
        );
        assert_eq!(shear(&lps), None);
        // 30 degrees about x.
        let (s, c) = (0.5, 0.75_f64.sqrt());
        let oblique = grid([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]]);
        assert_eq!(
            orientation(&oblique, Format::Nifti1),
            "x right, y anterior (oblique by 30.0 degrees), z superior (oblique by 30.0 degrees)"
        );
        assert_eq!(shear(&oblique), None);
    }

    #[test]
    fn a_sheared_grid_says_between_which_axes() {
        let tilted = grid([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 1.0]]);
        assert_eq!(
            shear(&tilted).as_deref(),
            Some("y and z meet at 45.0 degrees")
        );
    }
}
