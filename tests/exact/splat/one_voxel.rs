//! One voxel of 1 among zeros: along every ray the integral of one Gaussian, which is taken here in the world.

use super::{
    DIMS, NUMBER, PLACE, cubes, function, pictures, ray_of, scene, settings, sheared, shots, values,
};
use crate::shared::{PictureCase, Worst, volume_of};
use glam::{DMat3, DVec3, dvec3};
use stratavox::camera::Projection;
use stratavox::picture::LayerKind;
use stratavox::technique::Mode;
use stratavox::technique::splat::{Sheets, Splat};

/// The centre of the voxel.
const CENTER: DVec3 = dvec3(6.5, 5.5, 7.5);

/// World length of a pixel at the centre of the box, which the camera looks at.
fn pixel(shot: &PictureCase) -> f64 {
    let distance = match shot.camera.projection.is_perspective() {
        true => (shot.grid.center() - shot.camera.eye).length(),
        false => 1.0,
    };
    distance * shot.camera.plane_height() / f64::from(shot.extent[1])
}

/// exp(-b^2 / 2) |det A| / (2 pi sqrt(det C r.C^-1 r)) / (1 - 2^-bits) for b^2 <= 2 bits ln 2, with C = h^2 A A^T + lambda I the
/// covariance in the world.
fn holds(shot: &PictureCase) {
    let volume = volume_of(DIMS, shot.grid.world_from_voxel, |p| {
        f64::from(u8::from(p.distance(CENTER) < 0.1))
    });
    let Splat {
        std,
        low_pass,
        cut_bits,
        ..
    } = shot.settings.splat;
    let a = shot.grid.world_from_voxel.matrix3;
    let thinnest = std
        * [0, 1, 2]
            .map(|k| a.col(k).length())
            .into_iter()
            .fold(f64::INFINITY, f64::min);
    let lambda = ((low_pass * pixel(shot)).powi(2) - thinnest.powi(2)).max(0.0);
    let covariance = a * a.transpose() * std.powi(2) + DMat3::from_diagonal(DVec3::splat(lambda));
    let precision = covariance.inverse();
    let bits = f64::from(cut_bits);
    let end = (2.0 * bits * std::f64::consts::LN_2).sqrt();
    let center = shot.grid.world_from_voxel.transform_point3(CENTER) - shot.grid.center();
    let f = function();
    for (name, picture) in pictures(&scene(shot, &volume, &f), &[LayerKind::Value]) {
        let what = format!(
            "{name}: {cut_bits} bits, low pass {low_pass}, {}",
            shot.what()
        );
        let mut worst = Worst::new(what);
        let mut met = 0;
        for (pixel, &found) in shot.pixels().zip(values(&picture)) {
            let ray = ray_of(shot, pixel);
            let (w, r) = (center - ray.origin, ray.direction);
            let along = r.dot(precision * r);
            let b = (w.dot(precision * w) - r.dot(precision * w).powi(2) / along)
                .max(0.0)
                .sqrt();
            let peak = a.determinant().abs()
                / (std::f64::consts::TAU
                    * (covariance.determinant() * along).sqrt()
                    * (1.0 - (-bits).exp2()));
            // How far off b may be: as a place is, in deviations of the thinnest splat.
            let far = (ray.line.origin - CENTER).length() + 14.0;
            let off = PLACE * far / std;
            if (b - end).abs() <= off + 1e-6 {
                worst.leave_out();
                continue;
            }
            let wanted = if b < end {
                peak * (-0.5 * b * b).exp()
            } else {
                0.0
            };
            met += usize::from(wanted > 0.0);
            let found = if found.is_nan() {
                0.0
            } else {
                f64::from(found)
            };
            // The steepest of exp(-b^2 / 2), at b = 1.
            let allowed = peak * (off * (-0.5f64).exp() + NUMBER);
            worst.take(pixel, found - wanted, allowed);
        }
        worst.assert_holds();
        assert!(met >= 20, "only {met} pixels see it");
    }
}

fn near(shot: PictureCase) -> PictureCase {
    let mut shot = shot;
    shot.extent = [40, 36];
    shot.camera.zoom = 2.5;
    shot
}

#[test]
fn a_voxel_is_a_gaussian_that_is_cut_where_it_has_fallen_to_a_power_of_two() {
    for grid in [cubes(), sheared()] {
        for bits in [4, 8, 20] {
            for shot in shots(grid, &settings(Mode::Xray, Sheets::Image)) {
                holds(&near(shot).with(|s| {
                    (s.splat.cut_bits, s.splat.low_pass) = (bits, 0.0);
                }));
            }
        }
    }
}

#[test]
fn a_voxel_that_pixels_are_wider_than_is_as_wide_and_less_high() {
    for grid in [cubes(), sheared()] {
        for shot in shots(grid, &settings(Mode::Xray, Sheets::Image)) {
            let shot = near(shot);
            let low_pass = 1.5 / pixel(&shot);
            holds(&shot.with(|s| s.splat.low_pass = low_pass));
        }
    }
}

#[test]
fn a_voxel_is_a_gaussian_from_a_thousand_voxels_away_and_from_near_by() {
    let [_, shot] = shots(cubes(), &settings(Mode::Xray, Sheets::Image));
    let shot = near(shot).with(|s| s.splat.low_pass = 0.0);
    let mut far = shot.clone();
    let back = shot.camera.eye - shot.camera.target;
    far.camera.eye = shot.camera.target + 1000.0 * back.normalize();
    far.camera.projection = Projection::Perspective { fov_degrees: 1.0 };
    far.camera.zoom = 1.0;
    holds(&far);
    // Rays to both sides of the voxel are far from parallel: each takes its own way through it.
    let mut close = shot.clone();
    let center = shot.grid.world_from_voxel.transform_point3(CENTER);
    close.camera.eye = center + 7.0 * back.normalize();
    close.camera.target = center + dvec3(1.0, 1.5, -1.0);
    close.camera.projection = Projection::Perspective { fov_degrees: 60.0 };
    close.camera.zoom = 1.0;
    holds(&close);
}
