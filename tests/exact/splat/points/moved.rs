//! Scattered points keep what they are: their mass, however wide they are, wherever pixels are and however far away; and their
//! picture, where the world is moved and turned with the camera.

use super::{
    Case, EPS, check_composite, check_sums, cloud, function, pictures, random, settings, shots,
    values,
};
use crate::shared::device;
use glam::{DAffine3, DQuat, DVec3, dvec3};
use std::f64::consts::{PI, SQRT_2};
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::{LayerKind, Picture};
use stratavox::points::Points;
use stratavox::scene::{Beside, Scene};
use stratavox::technique::Mode;

const VALUE: f64 = 3.0;
const WEIGHT: f64 = 0.7;

/// By the CPU reference in f32 and by the device.
fn drawn(shot: &Case, points: &Points, extent: [u32; 2]) -> [(&'static str, Picture); 2] {
    let (volume, f) = (points.binned(), function());
    let scene = Scene {
        volume: &volume,
        transfer: Some(&f),
        beside: Beside::Points(points),
        camera: &shot.camera,
        extent_pixels: extent,
        settings: &shot.settings,
    };
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    let found = renderer.render(&scene, &[LayerKind::Value]).expect("drawn");
    [
        ("f32", reference::render::<f32>(&scene).expect("drawn")),
        ("device", found.picture),
    ]
}

fn sum(picture: &Picture) -> f64 {
    let found = values(picture).iter().filter(|v| !v.is_nan());
    found.map(|&v| f64::from(v)).sum()
}

/// Where an eye is that has all of a splat before it, in pixels.
fn away_from(std_pixels: f64) -> f64 {
    20.0 + 6.0 * std_pixels
}

/// One point somewhere in the middle pixel of a picture of so many pixels of length 1, its X-ray added up over all of them: the
/// error in parts.
fn error_of_mass(std_pixels: f64, low_pass: f64, side: u32, seed: u32) -> f64 {
    let mut unit = random(seed);
    let mut settings = settings(Mode::Xray);
    settings.splat.low_pass = low_pass;
    let target = dvec3(5.0, 5.0, 5.0);
    let shot = Case {
        camera: Camera {
            eye: target + away_from(std_pixels) * dvec3(0.6, -0.64, 0.48),
            target,
            up: DVec3::Z,
            projection: Projection::Orthographic {
                view_height: side.into(),
            },
            zoom: 1.0,
        },
        settings,
    };
    let place = target + dvec3(unit(), unit(), unit());
    let weights = Some(vec![WEIGHT as f32]);
    let points = Points::new(
        vec![place],
        vec![VALUE as f32],
        Some(vec![std_pixels as f32]),
        weights,
    );
    let points = points.expect("a point");
    let pictures = drawn(&shot, &points, [side; 2]);
    let errors = pictures.map(|(_, picture)| (sum(&picture) / (VALUE * WEIGHT) - 1.0).abs());
    errors.into_iter().fold(0.0, f64::max)
}

/// How far off, in parts, the sum over pixels of a splat may be that is so many of them wide, and whose eye and centre are together
/// so many pixels away from the middle of the box:
///
/// - Poisson's sum over pixels: 4 e^(-2 pi^2 wide^2).
/// - The rim that is cut off: 2^-20, and of the ring of pixels where it ends, sqrt(2) of them across, as much as happens to lie
///   inside: sqrt(2) R / wide of that.
/// - Terms and factors: 16 ulp. The sum of a picture is one of f64.
/// - A ray that is off by 8 ulp of these lengths: sqrt(pi / 2) of that, in deviations, if all are to the same side of the splat.
fn of_mass(wide: f64, away: f64) -> f64 {
    let poisson = 4.0 * (-2.0 * (PI * wide).powi(2)).exp();
    let rim = (1.0 + SQRT_2 * 5.27 / wide) * (-20f64).exp2();
    1.01 * poisson + rim + 16.0 * EPS + 8.0 * EPS * away / wide * (0.5 * PI).sqrt()
}

#[test]
fn the_mass_of_a_point_does_not_depend_on_how_wide_it_is_and_where_pixels_are() {
    let widths = [0.01, 0.1, 0.3, 0.75, 1.0, 1.7, 5.0, 20.0, 100.0];
    for (seed, std_pixels) in widths.into_iter().enumerate() {
        // All of it: 5.27 deviations, to both sides.
        let side = 16 + (10.6 * f64::max(std_pixels, 0.75)) as u32;
        let error = error_of_mass(std_pixels, 0.75, side, seed as u32 + 1);
        let allowed = of_mass(f64::max(std_pixels, 0.75), away_from(std_pixels));
        println!("{std_pixels} pixels wide: mass off by {error:.2e}, allowed {allowed:.2e}");
        assert!(error < allowed, "{std_pixels}: {error} {allowed}");
    }
    let thin = (1..9).map(|seed| error_of_mass(0.01, 0.5, 24, seed));
    assert!(thin.fold(0.0, f64::max) > 1e-2, "half a pixel is too thin");
}

/// At depth z a pixel is z times as large as at depth 1, and no splat thinner than 0.75 of it: h. Rays of a pixel further from the
/// middle pass by z sin, where pixels are z tan apart: with e = (h / z)^2 the sum over pixels is
///
/// ```text
/// mean of exp(u^2 / 2 - sin^2(atan(u h / z)) z^2 / 2 h^2) = 1 + e <u^4> / 2 + e^2 (<u^8> / 8 - <u^6> / 2) + .. = 1 + 4 e + 24 e^2 + ..
/// ```
#[test]
fn a_point_keeps_its_mass_however_far_away_it_is() {
    const SIDE: u32 = 24;
    const DEGREES: f64 = 20.0;
    let slope = 2.0 * (0.5 * DEGREES.to_radians()).tan() / f64::from(SIDE);
    let e = (0.75 * slope).powi(2);
    for distance in [20.0, 200.0, 2e3, 2e4] {
        let eye = dvec3(1.0, 2.0, 3.0);
        let forward = dvec3(0.6, -0.64, 0.48);
        let pixel = slope * distance;
        let shot = Case {
            camera: Camera {
                eye,
                target: eye + forward,
                up: DVec3::Z,
                projection: Projection::Perspective {
                    fov_degrees: DEGREES,
                },
                zoom: 1.0,
            },
            settings: settings(Mode::Xray),
        };
        let place = eye + distance * forward;
        let points = Points::new(vec![place], vec![VALUE as f32], Some(vec![0.05]), None);
        for (name, picture) in drawn(&shot, &points.expect("a point"), [SIDE; 2]) {
            let off = sum(&picture) * pixel * pixel / VALUE - (1.0 + 4.0 * e);
            let allowed = 30.0 * e * e + of_mass(0.75, 2.0 / slope);
            println!("{name}, {distance}: mass off by {off:.2e}, allowed {allowed:.2e}");
            assert!(off.abs() < allowed, "{name}, {distance}: {off}, {allowed}");
        }
    }
}

#[test]
fn a_world_that_is_moved_and_turned_with_its_camera_looks_the_same() {
    let points = cloud(300, 12);
    let turn = DQuat::from_axis_angle(dvec3(1.0, 2.0, -0.5).normalize(), 1.1);
    let moved = DAffine3::from_rotation_translation(turn, dvec3(-40.0, 25.0, 60.0));
    let places = points.places().iter().map(|&p| moved.transform_point3(p));
    let weights = (0..points.len()).map(|i| points.weight(i)).collect();
    let (values, stds) = (points.values().to_vec(), points.stds().to_vec());
    let elsewhere = Points::new(places.collect(), values, Some(stds), Some(weights));
    let elsewhere = elsewhere.expect("points");
    for mode in [Mode::Composite, Mode::Xray, Mode::Average] {
        for shot in &shots(mode) {
            let other = Case {
                camera: Camera {
                    eye: moved.transform_point3(shot.camera.eye),
                    target: moved.transform_point3(shot.camera.target),
                    up: moved.transform_vector3(shot.camera.up),
                    ..shot.camera
                },
                settings: shot.settings.clone(),
            };
            // The pictures of the other world are held to the points of this one.
            let layers: &[LayerKind] = match mode {
                Mode::Composite => &[],
                _ => &[LayerKind::Value],
            };
            for (name, picture) in pictures(&other, &elsewhere, layers) {
                println!("{name}:");
                match mode {
                    Mode::Composite => check_composite(shot, &points, &picture, None),
                    _ => check_sums(shot, &points, &picture, None),
                }
                .assert_holds();
            }
        }
    }
}
