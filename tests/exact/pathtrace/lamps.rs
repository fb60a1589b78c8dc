//! Lights at a place, against integrals over what shines.

use super::{assert_near, at, drawn, eye, layer, matter, mean, scene, settings};
use crate::shared::volume_of;
use glam::{DAffine3, DVec3, dvec3};
use std::f64::consts::{PI, TAU};
use stratavox::camera::{Camera, Projection};
use stratavox::technique::pathtrace::{Lamp, LampShape, PathTracing};

/// Half the side of a box of fog around the origin.
const HALF: f64 = 8.0;
const EXTINCTION: f64 = 0.1;

/// Light that fog scatters once to a ray through the origin along x: `fluence` says what comes to a point.
fn in_fog(fluence: impl Fn(DVec3) -> f64) -> f64 {
    let steps = 400;
    let length = 2.0 * HALF / f64::from(steps);
    let source = |i: i32| {
        let t = length * (f64::from(i) + 0.5);
        let there = fluence(dvec3(t - HALF, 0.0, 0.0));
        EXTINCTION * length * (-EXTINCTION * t).exp() * there / (4.0 * PI)
    };
    (0..steps).map(source).sum()
}

fn found_in_fog(lamp: Lamp) -> [f64; 2] {
    let place =
        DAffine3::from_translation(DVec3::splat(-HALF)) * DAffine3::from_scale(DVec3::splat(HALF));
    let volume = volume_of([2; 3], place, |_| 1.0);
    let function = matter([1.0; 3], &[(0.0, EXTINCTION)]);
    let camera = Camera {
        eye: dvec3(-20.0, 0.0, 0.0),
        target: DVec3::ZERO,
        up: DVec3::Z,
        projection: Projection::Orthographic { view_height: 1e-3 },
        zoom: 1.0,
    };
    let settings = settings(PathTracing {
        samples: 32,
        bounces: Some(1),
        lamps: vec![lamp],
        ..PathTracing::default()
    });
    let scene = scene(&volume, &function, &camera, &settings, [48; 2]);
    mean(&drawn(&scene), 0)
}

/// Directions in which a ball of radius r at the distance d shines, by the cosine to its middle.
#[test]
fn a_ball_in_fog_shines_to_all_sides_and_into_itself() {
    for (place, radius) in [
        (dvec3(1.0, 0.5, 0.0), 1.5),
        (dvec3(-1.0, 3.0, 1.0), 2.0),
        (dvec3(2.0, 4.0, -1.0), 0.01),
    ] {
        let radiance = place.length_squared() / (radius * radius);
        let wanted = in_fog(|point| {
            let squared = point.distance_squared(place);
            let is_inside = squared < radius * radius;
            let least = match is_inside {
                true => -1.0,
                false => (1.0 - radius * radius / squared).sqrt(),
            };
            let steps = 1000;
            let of = |i: i32| {
                let cosine = least + (1.0 - least) * (f64::from(i) + 0.5) / f64::from(steps);
                let chord = radius * radius - squared * (1.0 - cosine * cosine);
                let side = if is_inside { 1.0 } else { -1.0 };
                let reach = squared.sqrt() * cosine + side * chord.max(0.0).sqrt();
                (-EXTINCTION * reach).exp()
            };
            let sum: f64 = (0..steps).map(of).sum();
            TAU * radiance * (1.0 - least) * sum / f64::from(steps)
        });
        let lamp = Lamp {
            place,
            shape: LampShape::Sphere {
                radius: Some(radius),
            },
            srgb: [1.0; 3],
        };
        assert_near(&format!("{place} {radius}"), found_in_fog(lamp), wanted);
    }
}

/// By the areas of a disc, which directions are not drawn by.
#[test]
fn a_disc_in_fog_shines_to_the_side_of_the_target() {
    let (place, radius) = (dvec3(3.0, 2.0, 0.0), 2.0);
    let facing = -place.normalize();
    let across = facing.any_orthonormal_vector();
    let along = facing.cross(across);
    let radiance = (place.length_squared() + radius * radius) / (radius * radius);
    let (rings, parts) = (60, 60);
    let wanted = in_fog(|point| {
        let mut sum = 0.0;
        for i in 0..rings {
            let r = radius * (f64::from(i) + 0.5) / f64::from(rings);
            for j in 0..parts {
                let (y, x) = (TAU * (f64::from(j) + 0.5) / f64::from(parts)).sin_cos();
                let to_light = place + r * (x * across + y * along) - point;
                let distance = to_light.length();
                let cosine = -facing.dot(to_light) / distance;
                let seen = cosine.max(0.0) * (-EXTINCTION * distance).exp();
                sum += r * seen / (distance * distance);
            }
        }
        sum * radiance * radius / f64::from(rings) * TAU / f64::from(parts)
    });
    let lamp = Lamp {
        place,
        shape: LampShape::Disc { radius },
        srgb: [1.0; 3],
    };
    assert_near("disc", found_in_fog(lamp), wanted);
}

/// Surfaces across an even rise, under a ball all of which they see: albedo L n . l / pi over its cone.
#[test]
fn surfaces_under_a_ball_reflect_by_the_cosine_to_each_part_of_it() {
    let volume = layer(|z| z);
    let (mu, mu0, depth, sine) = (0.6_f64, 0.8, 2.0, 0.5);
    let function = matter([0.5; 3], &[(0.0, depth)]);
    let camera = eye(at(mu, 0.0));
    let place = 1e3 * at(mu0, 2.0);
    let settings = settings(PathTracing {
        samples: 16,
        bounces: Some(1),
        surface: 1e4,
        lamps: vec![Lamp {
            place,
            shape: LampShape::Sphere {
                radius: Some(1e3 * sine),
            },
            srgb: [1.0; 3],
        }],
        ..PathTracing::default()
    });
    let scene = scene(&volume, &function, &camera, &settings, [48; 2]);
    let axis = place.normalize();
    let across = axis.any_orthonormal_vector();
    let along = axis.cross(across);
    let least = (1.0 - sine * sine).sqrt();
    let n = 200;
    let mut wanted = 0.0;
    for i in 0..n {
        let cosine = least + (1.0 - least) * (f64::from(i) + 0.5) / f64::from(n);
        let aside = (1.0 - cosine * cosine).sqrt();
        for j in 0..n {
            let (y, x) = (TAU * (f64::from(j) + 0.5) / f64::from(n)).sin_cos();
            let m = (cosine * axis + aside * (x * across + y * along)).z;
            let lost = 1.0 - (-depth * (1.0 / mu + 1.0 / m)).exp();
            wanted += m * m / (mu + m) * lost;
        }
    }
    // L = 1 / sine^2, of solid angle 2 pi (1 - least) in all.
    wanted *= 0.5 / PI / (sine * sine) * TAU * (1.0 - least) / f64::from(n * n);
    assert_near("ball", mean(&drawn(&scene), 0), wanted);
}
