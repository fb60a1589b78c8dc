//! Splats added up along rays: integrals of the splatted field.

use super::{
    DIMS, DIRECTIONS, cubes, function, noise, pictures, ray_of, scene, seen_from, settings,
    sheared, shots, values,
};
use crate::shared::{Worst, volume_of, waves};
use glam::{DVec3, dvec3};
use stratavox::camera::Projection;
use stratavox::offscreen::reference;
use stratavox::picture::LayerKind;
use stratavox::technique::splat::Sheets;
use stratavox::technique::{ClipPlane, Mode};

/// s^2 -> a Gaussian of that variance in voxel space around the middle.
fn blob(variance: f64) -> impl Fn(DVec3) -> f64 {
    let middle = 0.5 * DVec3::from_array(DIMS.map(f64::from));
    move |p| (-0.5 * (p - middle).length_squared() / variance).exp()
}

#[test]
fn an_x_ray_of_a_gaussian_is_that_of_a_wider_one() {
    let grid = cubes();
    let (s2, h2) = (1.21f64, 0.36);
    let volume = volume_of(DIMS, grid.world_from_voxel, blob(s2));
    let ripple = (-2.0 * std::f64::consts::PI.powi(2) * s2 * h2 / (s2 + h2)).exp();
    let law = (1.0 + 2.0 * ripple).powi(2) - 1.0;
    for shot in shots(grid, &settings(Mode::Xray, Sheets::Image)) {
        let shot = shot.with(|s| s.splat.low_pass = 0.0);
        let f = function();
        let middle = 0.5 * DVec3::from_array(DIMS.map(f64::from));
        // The integral of the data is (2 pi s^2)^(3/2); of a Gaussian of variance s^2 + h^2 a line takes 1 / (2 pi (s^2 + h^2)).
        let peak = (std::f64::consts::TAU * s2).powf(1.5) / (std::f64::consts::TAU * (s2 + h2));
        for (name, picture) in pictures(&scene(&shot, &volume, &f), &[LayerKind::Value]) {
            let mut worst = Worst::new(format!("{name}: {}", shot.what()));
            for (pixel, &found) in shot.pixels().zip(values(&picture)) {
                let ray = ray_of(&shot, pixel).line;
                let to = middle - ray.origin;
                let along = to.dot(ray.direction) / ray.direction.length();
                let wanted =
                    peak * (-0.5 * (to.length_squared() - along * along) / (s2 + h2)).exp();
                if !found.is_nan() {
                    worst.take(
                        pixel,
                        f64::from(found) - wanted,
                        law * peak + 1e-5 * peak + 2e-4 * wanted,
                    );
                } else {
                    worst.take(pixel, wanted, 1e-3 * peak);
                }
            }
            worst.assert_holds();
        }
    }
}

#[test]
fn an_x_ray_is_linear_and_keeps_mass() {
    let grid = sheared();
    let (a, b) = (
        volume_of(DIMS, grid.world_from_voxel, noise),
        volume_of(DIMS, grid.world_from_voxel, waves),
    );
    let both = volume_of(DIMS, grid.world_from_voxel, |p| noise(p) + waves(p));
    let f = function();
    let [shot, perspective] = shots(grid, &settings(Mode::Xray, Sheets::Image));
    for shot in [&shot, &perspective] {
        let x_rays =
            [&a, &b, &both].map(|volume| pictures(&scene(shot, volume, &f), &[LayerKind::Value]));
        for (way, (name, _)) in x_rays[0].iter().enumerate() {
            let mut worst = Worst::new(format!("{name}: {}", shot.what()));
            let [a, b, both] = [0, 1, 2].map(|n| values(&x_rays[n][way].1));
            for (i, pixel) in shot.pixels().enumerate() {
                if !both[i].is_nan() {
                    worst.take(
                        pixel,
                        f64::from(a[i] + b[i] - both[i]),
                        1e-5 * f64::from(both[i].abs().max(1.0)),
                    );
                }
            }
            worst.assert_holds();
        }
    }
    // What leaves the picture is lost, and pixels are finer than splats.
    let mut shot = shot;
    shot.extent = [96, 88];
    shot.camera.projection = Projection::Orthographic {
        view_height: 1.6 * (grid.world_from_voxel.matrix3 * grid.far_corner()).length(),
    };
    let pixel = shot.camera.rays(shot.extent);
    let area = pixel.origin_dx.cross(pixel.origin_dy).length();
    for (name, picture) in pictures(&scene(&shot, &a, &f), &[LayerKind::Value]) {
        let sum: f64 = values(&picture)
            .iter()
            .filter(|v| !v.is_nan())
            .map(|&v| f64::from(v))
            .sum();
        let whole: f64 = (0..a.voxels.len())
            .map(|i| f64::from(a.voxels.stored(i)))
            .sum();
        let wanted = whole * grid.world_from_voxel.matrix3.determinant().abs();
        let off = sum * area / wanted - 1.0;
        assert!(off.abs() < 1e-3, "{name}: mass is off by {off:e}");
    }
}

#[test]
fn wider_pixels_widen_splats_and_keep_their_sum() {
    let grid = cubes();
    let volume = volume_of(DIMS, grid.world_from_voxel, noise);
    let f = function();
    let sum_of = |pixels: u32, low_pass: f64| {
        let mut shot = seen_from(grid, DIRECTIONS[2], &settings(Mode::Xray, Sheets::Image));
        shot.settings.splat.low_pass = low_pass;
        shot.extent = [pixels, pixels];
        shot.camera.projection = Projection::Orthographic { view_height: 40.0 };
        let rays = shot.camera.rays(shot.extent);
        let area = rays.origin_dx.cross(rays.origin_dy).length();
        let found = pictures(&scene(&shot, &volume, &f), &[LayerKind::Value]);
        found.map(|(_, picture)| {
            let sum = values(&picture).iter().filter(|v| !v.is_nan());
            area * sum.map(|&v| f64::from(v)).sum::<f64>()
        })
    };
    let fine = sum_of(80, 0.75);
    for pixels in [20, 10] {
        let coarse = sum_of(pixels, 0.75);
        for (fine, coarse) in fine.iter().zip(coarse) {
            let off = coarse / fine - 1.0;
            assert!(off.abs() < 1e-3, "{pixels} pixels: off by {off:e}");
        }
    }
}

#[test]
fn what_cuts_cut_keeps_by_centres_where_splats_are_added() {
    let grid = cubes();
    let volume = volume_of(DIMS, grid.world_from_voxel, noise);
    let f = function();
    let crop = [dvec3(2.6, 0.0, 3.5), dvec3(9.4, 12.0, 11.0)];
    let plane = ClipPlane {
        normal: dvec3(0.3, 1.0, 0.2),
        offset: dvec3(0.3, 1.0, 0.2).dot(grid.center()),
    };
    let world = grid.world_from_voxel;
    let kept = |p: DVec3| {
        p.cmpge(crop[0]).all()
            && p.cmplt(crop[1]).all()
            && plane.normal.dot(world.transform_point3(p)) >= plane.offset
    };
    let rest = volume_of(DIMS, world, |p| if kept(p) { noise(p) } else { 0.0 });
    for shot in shots(grid, &settings(Mode::Xray, Sheets::Image)) {
        let cut = shot.with(|s| (s.crop, s.clip_planes) = (Some(crop), vec![plane]));
        let wanted = reference::render::<f64>(&scene(&shot, &rest, &f)).unwrap();
        for (name, picture) in pictures(&scene(&cut, &volume, &f), &[LayerKind::Value]) {
            let mut worst = Worst::new(format!("{name}: {}", shot.what()));
            for (pixel, (&found, &wanted)) in shot
                .pixels()
                .zip(values(&picture).iter().zip(values(&wanted)))
            {
                let number = |v: f32| if v.is_nan() { 0.0 } else { f64::from(v) };
                worst.take(pixel, number(found) - number(wanted), 1e-5);
            }
            worst.assert_holds();
        }
    }
}
