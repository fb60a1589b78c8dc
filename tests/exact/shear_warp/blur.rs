//! The blur of shear-warp in closed form: the slices' own filter and the warp's are tents, of variance 1/6 voxel^2 and 1/6 base
//! pixel^2 along both axes of the base plane. In an X-ray of one voxel, in the mean over where base pixels lie beside it,
//!
//! ```text
//! covariance of the picture = (1/6) (1 + 1 / q^2) W W^T        W from base plane to picture plane, along the rays
//! ```

use super::{cubes, drawn, settings};
use crate::shared::{PictureCase, volume_of};
use glam::{DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::technique::Mode;

const SIDE: u32 = 16;
const PIXELS: u32 = 120;
const VIEW: f64 = 7.0;

/// (mass, variance across, covariance, variance down) of the picture of one voxel.
fn moments(per_voxel: f64, slice: u32, towards: DVec3) -> [f64; 4] {
    let grid = cubes([SIDE; 3]);
    let voxel = dvec3(8.5, 8.5, f64::from(slice) + 0.5);
    let one = |p: DVec3| f64::from(u8::from(p.distance(voxel) < 0.1));
    let volume = volume_of(grid.dims, grid.world_from_voxel, one);
    let target = grid.world_from_voxel.transform_point3(voxel);
    let shot = PictureCase {
        grid,
        camera: Camera {
            eye: target - 30.0 * towards,
            target,
            up: DVec3::Y,
            projection: Projection::Orthographic { view_height: VIEW },
            zoom: 1.0,
        },
        extent: [PIXELS; 2],
        settings: settings(Mode::Xray, per_voxel),
    };
    let picture = drawn(&shot, &volume);
    let pixel_world = VIEW / f64::from(PIXELS);
    let half = 0.5 * f64::from(PIXELS);
    let all = shot
        .pixels()
        .zip(&picture.layers[1].values)
        .map(|(pixel, &value)| {
            let place = pixel.map(|n| (f64::from(n) + 0.5 - half) * pixel_world);
            (place, f64::from(if value.is_nan() { 0.0 } else { value }))
        });
    let all: Vec<_> = all.collect();
    let sum = all.iter().map(|(_, mass)| mass).sum::<f64>();
    let mean = |of: &dyn Fn([f64; 2]) -> f64| {
        all.iter()
            .map(|&(place, mass)| mass * of(place))
            .sum::<f64>()
            / sum
    };
    let middle = [mean(&|[x, _]| x), mean(&|[_, y]| y)];
    let about = |k: usize, l: usize| mean(&|p| (p[k] - middle[k]) * (p[l] - middle[l]));
    let mass = sum * pixel_world * pixel_world;
    [mass, about(0, 0), about(0, 1), about(1, 1)]
}

#[test]
fn one_voxel_is_blurred_by_two_tents_across_the_slices() {
    // From slice to slice a ray moves by 9/16 and 5/16 of a voxel: each sixteenth once.
    let towards = dvec3(9.0, 5.0, 16.0).normalize();
    let right = towards.cross(DVec3::Y).normalize();
    let down = towards.cross(right).normalize();
    let w = |side: DVec3| [side.x, side.y];
    let [across, along] = [w(right), w(down)];
    let times = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    for per_voxel in [1.0, 2.0, 4.0] {
        let all = (0..SIDE).map(|slice| moments(per_voxel, slice, towards));
        let sum = all.fold([0.0; 4], |sum, one| {
            std::array::from_fn(|k| sum[k] + one[k])
        });
        let [mass, xx, xy, yy] = sum.map(|sum| sum / f64::from(SIDE));
        // The X-ray of one voxel has its volume for a mass.
        assert!((mass - 1.0).abs() < 1e-3, "mass {mass} at {per_voxel}");
        let blur = (1.0 + f64::powi(per_voxel, -2)) / 6.0;
        for (found, wanted) in [
            (xx, times(across, across)),
            (xy.abs(), times(across, along).abs()),
            (yy, times(along, along)),
        ] {
            assert!(
                (found - blur * wanted).abs() < 0.02 * blur,
                "{found}, wanted {} at {per_voxel} base pixels a voxel",
                blur * wanted
            );
        }
    }
}
