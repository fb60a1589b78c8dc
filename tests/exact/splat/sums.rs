//! Splats added up along rays: integrals of the splatted field.

use super::{
    DIMS, DIRECTIONS, VOXELS, cubes, function, noise, of_splats, pictures, ray_of, scene,
    seen_from, settings, sheared, shots, values,
};
use crate::shared::{Worst, volume_of, waves};
use glam::{DVec3, dvec3};
use stratavox::camera::Projection;
use stratavox::offscreen::reference;
use stratavox::picture::LayerKind;
use stratavox::technique::splat::{Sheets, Splat};
use stratavox::technique::{ClipPlane, Mode};

/// s^2 -> a Gaussian of that variance in voxel space around the middle.
fn blob(variance: f64) -> impl Fn(DVec3) -> f64 {
    let middle = 0.5 * DVec3::from_array(DIMS.map(f64::from));
    move |p| (-0.5 * (p - middle).length_squared() / variance).exp()
}

/// How far off, of itself, the sum of an X-ray over its pixels may be, of splats that are `wide` pixels where they are thinnest
/// and are seen from so many voxels away:
///
/// - Poisson's sum over pixels: (1 + 2 e)^2 - 1 with e = exp(-2 pi^2 wide^2).
/// - A splat ends at a step of 2^-bits of its peak, and which pixels of the ring where it does, sqrt(2) of them across, lie
///   inside is as it happens: ring over integral is sqrt(2) R / wide.
/// - A place that is off by d deviations: d times the integral of b^2 e^(-b^2 / 2), sqrt(pi / 2).
/// - Numbers, and the sum of those of a ray: voxels of 13 slices, 7 across each way.
fn sum_error(wide: f64, voxels_away: f64) -> f64 {
    let bits = f64::from(Splat::default().cut_bits);
    let ripple = (-2.0 * (std::f64::consts::PI * wide).powi(2)).exp();
    let reach = (2.0 * bits * std::f64::consts::LN_2).sqrt();
    let ring = std::f64::consts::SQRT_2 * reach / wide * (-bits).exp2();
    let sum = VOXELS / f64::from(1 << 24);
    (1.0 + 2.0 * ripple).powi(2) - 1.0 + ring + of_splats(voxels_away) + sum
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
    // No direction is shorter in the world than 1 over the norm of the inverse says.
    let inverse = grid.world_from_voxel.matrix3.inverse();
    let norm = inverse
        .to_cols_array()
        .map(|x| x * x)
        .iter()
        .sum::<f64>()
        .sqrt();
    let away =
        inverse.mul_vec3(shot.camera.eye - grid.center()).length() + grid.far_corner().length();
    let allowed = sum_error(0.6 / norm / area.sqrt(), away);
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
        println!("{name}: mass is off by {off:e}, allowed {allowed:e}");
        assert!(off.abs() < allowed, "{name}: mass is off by {off:e}");
    }
}

#[test]
fn wider_pixels_widen_splats_and_keep_their_sum() {
    let grid = cubes();
    let volume = volume_of(DIMS, grid.world_from_voxel, noise);
    let f = function();
    const LOW_PASS: f64 = 0.75;
    // All that splats reach is in the picture.
    let sum_of = |pixels: u32, pixel: f64| {
        let mut shot = seen_from(grid, DIRECTIONS[2], &settings(Mode::Xray, Sheets::Image));
        shot.settings.splat.low_pass = LOW_PASS;
        shot.extent = [pixels, pixels];
        shot.camera.projection = Projection::Orthographic {
            view_height: f64::from(pixels) * pixel,
        };
        let away = (shot.camera.eye - grid.center()).length() + grid.far_corner().length();
        let wide = LOW_PASS.max(Splat::default().std / pixel);
        let found = pictures(&scene(&shot, &volume, &f), &[LayerKind::Value]);
        let sums = found.map(|(_, picture)| {
            let sum = values(&picture).iter().filter(|v| !v.is_nan());
            pixel * pixel * sum.map(|&v| f64::from(v)).sum::<f64>()
        });
        (sums, sum_error(wide, away))
    };
    let (fine, of_fine) = sum_of(80, 0.5);
    for (pixels, pixel) in [(24, 2.0), (16, 4.0)] {
        let (coarse, of_coarse) = sum_of(pixels, pixel);
        for (fine, coarse) in fine.iter().zip(coarse) {
            let (off, allowed) = (coarse / fine - 1.0, of_fine + of_coarse);
            println!("pixels of {pixel}: off by {off:e}, allowed {allowed:e}");
            assert!(off.abs() < allowed, "pixels of {pixel}: off by {off:e}");
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
