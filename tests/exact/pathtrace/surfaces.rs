//! What surfaces send back.

use super::{assert_near, at, drawn, eye, layer, light, matter, mean, scene, settings};
use stratavox::technique::pathtrace::PathTracing;

/// Where values rise evenly all collisions are with surfaces across the rise (Lambert): n . l in place of pi p(c).
#[test]
fn surfaces_reflect_by_the_cosine_to_their_normal() {
    let volume = layer(|z| z);
    let function = matter([1.0, 0.5, 0.25], &[(0.0, 2.0)]);
    let (mu, mu0, depth) = (0.6_f64, 0.8, 2.0);
    let camera = eye(at(mu, 0.0));
    let settings = settings(PathTracing {
        samples: 8,
        bounces: Some(1),
        surface: 1e4,
        lights: vec![light(at(mu0, 2.0))],
        ..PathTracing::default()
    });
    let scene = scene(&volume, &function, &camera, &settings, [48; 2]);
    let picture = drawn(&scene);
    // Half a voxel at each face lies beyond the outermost centres, where a tap finds the edge: half the gradient.
    for (channel, albedo) in [1.0, 0.5, 0.25].into_iter().enumerate() {
        let lost = 1.0 - (-depth * (1.0 / mu + 1.0 / mu0)).exp();
        let wanted = albedo * mu0 * mu0 / (mu + mu0) * lost;
        assert_near("surface", mean(&picture, channel), wanted);
    }
}

/// How a coated surface sends light from one cosine to another, their azimuths a turn apart: pi f, by the formulas of
/// Ashikhmin and Shirley 2000, Walter et al. 2007 and Schlick 1994, written out once more.
fn coated(f0: f64, roughness: f64, albedo: f64, [mu, mu0, turn]: [f64; 3]) -> f64 {
    let (to_eye, to_light) = (at(mu, 0.0), at(mu0, turn));
    let half = (to_eye + to_light).normalize();
    let alpha = roughness * roughness;
    let squared = alpha * alpha;
    let pi = std::f64::consts::PI;
    let d = squared / (pi * (half.z * half.z * (squared - 1.0) + 1.0).powi(2));
    let lambda = |c: f64| 0.5 * ((1.0 + squared * (1.0 - c * c) / (c * c)).sqrt() - 1.0);
    let g = 1.0 / (1.0 + lambda(mu) + lambda(mu0));
    let f = f0 + (1.0 - f0) * (1.0 - to_eye.dot(half)).powi(5);
    let coat = d * g * f / (4.0 * mu * mu0);
    let of = |c: f64| 1.0 - (1.0 - 0.5 * c).powi(5);
    let below = 28.0 * albedo / (23.0 * pi) * (1.0 - f0) * of(mu) * of(mu0);
    pi * (below + coat)
}

/// All collisions are with surfaces across an even rise: of light once reflected, pi f mu0 in place of the albedo's part.
#[test]
fn coated_surfaces_reflect_what_their_formulas_say() {
    let volume = layer(|z| z);
    let depth = 2.0;
    for (f0, roughness, mu, mu0, turn) in [
        (0.04, 0.45, 0.6, 0.8, 2.0),
        (0.04, 0.3, 0.7, 0.7, std::f64::consts::PI),
        (0.9, 0.6, 0.3, 0.5, 3.0),
    ] {
        let function = matter([0.8, 0.4, 0.0], &[(0.0, depth)]);
        let camera = eye(at(mu, 0.0));
        let settings = settings(PathTracing {
            samples: 8,
            bounces: Some(1),
            surface: 1e4,
            f0,
            roughness,
            lights: vec![light(at(mu0, turn))],
            ..PathTracing::default()
        });
        let scene = scene(&volume, &function, &camera, &settings, [48; 2]);
        let picture = drawn(&scene);
        for (channel, albedo) in [0.8, 0.4, 0.0].into_iter().enumerate() {
            let lost = 1.0 - (-depth * (1.0 / mu + 1.0 / mu0)).exp();
            let wanted =
                coated(f0, roughness, albedo, [mu, mu0, turn]) * mu0 * mu0 / (mu + mu0) * lost;
            assert_near(
                &format!("{f0} {roughness}"),
                mean(&picture, channel),
                wanted,
            );
        }
    }
}

/// The same under an even sky, which is found by the directions that are drawn: the integral over the half sphere.
#[test]
fn directions_from_coated_surfaces_are_drawn_as_they_reflect() {
    let volume = layer(|z| z);
    let (depth, mu, albedo) = (2.0, 0.6, 0.5);
    for (f0, roughness) in [(0.04, 0.45), (0.8, 0.3)] {
        let function = matter([albedo; 3], &[(0.0, depth)]);
        let camera = eye(at(mu, 0.0));
        let settings = settings(PathTracing {
            samples: 16,
            bounces: Some(1),
            surface: 1e4,
            f0,
            roughness,
            sky: [1.0; 3],
            ..PathTracing::default()
        });
        let scene = scene(&volume, &function, &camera, &settings, [48; 2]);
        let (rows, columns) = (400, 400);
        let mut wanted = 0.0;
        for i in 0..rows {
            let mu0 = (f64::from(i) + 0.5) / f64::from(rows);
            let lost = 1.0 - (-depth * (1.0 / mu + 1.0 / mu0)).exp();
            for j in 0..columns {
                let turn = std::f64::consts::TAU * (f64::from(j) + 0.5) / f64::from(columns);
                wanted +=
                    coated(f0, roughness, albedo, [mu, mu0, turn]) * mu0 * mu0 / (mu + mu0) * lost;
            }
        }
        // Over 2 pi of solid angle, of f = pi f / pi.
        wanted *= 2.0 / f64::from(rows * columns);
        assert_near(
            &format!("{f0} {roughness}"),
            mean(&drawn(&scene), 0),
            wanted,
        );
    }
}
