//! How much height is exaggerated: the weather lies in a sheet ten kilometres high and thousands wide.
//!
//! ```text
//! factor = width / (4 height),   to two digits, where it is above 1
//! ```
//!
//! Only the picture is stretched: `info` tells the world as it is.

use super::{Error, flags::SceneFlags};
use crate::volume::Grid;
use glam::{DAffine3, DVec3};

/// A picture's box is at most so many times as wide as high.
const WIDEST: f64 = 4.0;

/// What a volume of the Earth is stretched by along z where nobody says; 1 for one of a single layer.
pub fn suggested(grid: &Grid) -> f64 {
    let [width, depth, height] = sides(grid);
    let factor = width.max(depth) / (WIDEST * height);
    if !(factor > 1.0 && factor.is_finite()) || grid.dims.contains(&1) {
        return 1.0;
    }
    // The nearest number that is written with two digits.
    format!("{factor:.1e}").parse().unwrap_or(factor)
}

/// Lengths of the world box around the grid along x, y, z.
fn sides(grid: &Grid) -> [f64; 3] {
    let far = grid.far_corner();
    let m = grid.world_from_voxel.matrix3;
    let columns = [m.x_axis * far.x, m.y_axis * far.y, m.z_axis * far.z];
    let sum = columns.into_iter().map(DVec3::abs).sum::<DVec3>();
    sum.to_array()
}

/// The affine with heights stretched.
pub fn stretched(world_from_voxel: DAffine3, factor: f64) -> DAffine3 {
    DAffine3::from_scale(DVec3::new(1.0, 1.0, factor)) * world_from_voxel
}

/// What the words and the grid make of it, and what a person should know.
pub fn factor(
    scene: &SceneFlags,
    grid: &Grid,
    is_earth: bool,
) -> Result<(f64, Option<String>), Error> {
    match scene.camera.exaggerate {
        Some(factor)
            if stretched(grid.world_from_voxel, factor)
                .matrix3
                .determinant()
                .is_normal() =>
        {
            Ok((factor, None))
        }
        Some(factor) => Err(Error::usage(
            format!("--exaggerate {factor}: no volume is left"),
            "--exaggerate 1",
        )),
        None if is_earth => {
            let factor = suggested(grid);
            let note = (factor > 1.0).then(|| {
                format!(
                    "heights are exaggerated {factor} times; --exaggerate 1 draws them as they are"
                )
            });
            Ok((factor, note))
        }
        None => Ok((1.0, None)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(spacing: [f64; 3], dims: [u32; 3]) -> Grid {
        Grid {
            dims,
            world_from_voxel: DAffine3::from_scale(DVec3::from_array(spacing)),
        }
    }

    #[test]
    fn a_flat_sheet_becomes_a_box_four_times_as_wide_as_high() {
        // 480 km by 300 km by 6 km.
        assert_eq!(suggested(&grid([10.0, -10.0, 0.1], [48, 30, 60])), 20.0);
        assert_eq!(suggested(&grid([1.0, 1.0, 0.05], [100, 100, 100])), 5.0);
        // 40000 km by 30 km: 333.3 to two digits.
        assert_eq!(suggested(&grid([100.0, 100.0, 1.0], [400, 200, 30])), 330.0);
        // 23 times a tenth is no f64 that is written so.
        let few = suggested(&grid([1.0, 1.0, 1.0], [92, 40, 10]));
        assert_eq!(few.to_string(), "2.3");
    }

    #[test]
    fn what_is_high_enough_and_a_single_layer_stay_as_they_are() {
        assert_eq!(suggested(&grid([1.0, 1.0, -1.0], [40, 40, 10])), 1.0);
        assert_eq!(suggested(&grid([1.0, 1.0, 1.0], [40, 40, 30])), 1.0);
        assert_eq!(suggested(&grid([1.0, 1.0, 0.001], [40, 40, 1])), 1.0);
    }

    #[test]
    fn only_heights_are_stretched() {
        let affine = DAffine3::from_translation(DVec3::new(1.0, 2.0, 3.0));
        let point = stretched(affine, 10.0).transform_point3(DVec3::ONE);
        assert_eq!(point, DVec3::new(2.0, 3.0, 40.0));
    }
}
