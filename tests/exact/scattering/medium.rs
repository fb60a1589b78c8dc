//! Matter of which the transfer function says what it does to light, by rays.

use super::{ASIDE, is_within, layer, single};
use crate::pathtrace::medium::{medium, points};
use crate::pathtrace::{around_blobs, at, blobs, drawn, eye, light, mean_of, scene};
use crate::shared::volume_of;
use glam::{DAffine3, dvec3};
use stratavox::offscreen::reference;
use stratavox::scene::Scene;
use stratavox::technique::pathtrace::{PathTracing, Phase};
use stratavox::technique::{Settings, SingleScattering, Technique};

/// Sums of E / sigma (1 - e^(-sigma h)) over segments are that of the whole ray; E d where nothing is in the way.
#[test]
fn rays_sum_what_matter_sends_out() {
    let (mu, emission, density) = (0.5, [0.9, 0.3, 0.1], 2.0);
    let (volume, camera) = (layer(8, ASIDE), eye(at(mu, 0.0)));
    for sigma in [1.5, 0.0] {
        let function = medium(
            points([(0.0, [0.0; 3]), (0.5, [sigma; 3]), (1.0, [sigma; 3])]),
            Vec::new(),
            points([(0.0, [0.0; 3]), (0.5, emission)]),
        );
        for conformance in [true, false] {
            let settings = Settings {
                conformance,
                ..single(
                    SingleScattering::Open,
                    PathTracing {
                        density,
                        ..PathTracing::default()
                    },
                )
            };
            let scene = scene(&volume, &function, &camera, &settings, [6, 5]);
            let depth = sigma * density / mu;
            let wanted = match sigma == 0.0 {
                true => emission[0] / mu,
                false => emission[0] / (sigma * density) * (1.0 - (-depth).exp()),
            };
            let what = format!("{sigma}, conformance {conformance}");
            is_within(&what, &drawn(&scene), wanted, 2e-5);
            let f64 = reference::render::<f64>(&scene).expect("a picture");
            is_within(&what, &f64, wanted, 2e-6);
        }
    }
}

/// Over a ramp of values the samples of a ray sum the integral of an extinction that is a straight line.
#[test]
fn extinction_is_linear_between_its_points() {
    let scale = dvec3(1.0, 1.0, 0.125);
    let place = DAffine3::from_translation(dvec3(-2.0, -2.0, -1.0)) * DAffine3::from_scale(scale);
    let volume = volume_of([4, 4, 8], place, |p| p.z / 8.0);
    let camera = eye(at(1.0, 0.0));
    let function = medium(
        points([(0.0, [0.0; 3]), (1.0, [3.0; 3])]),
        points([(0.0, [1.0; 3])]),
        Vec::new(),
    );
    let settings = Settings {
        conformance: true,
        ..single(
            SingleScattering::Open,
            PathTracing {
                lights: vec![light(at(0.8, 1.0))],
                ..PathTracing::default()
            },
        )
    };
    let picture = drawn(&scene(&volume, &function, &camera, &settings, [6, 5]));
    // Isotropic: a fourth of what is taken away, and nothing hinders light.
    is_within("ramp", &picture, 0.25 * (1.0 - (-1.5_f64).exp()), 2e-6);
}

/// Light that is scattered once, and light that matter sends straight to the eye: of each there are paths.
#[test]
fn rays_bring_what_paths_of_both_kinds_of_light_bring() {
    let (volume, camera) = (blobs(), around_blobs());
    let extinction = points([(0.1, [0.0; 3]), (0.4, [0.8; 3]), (1.0, [0.1; 3])]);
    let albedo = points([(0.0, [0.9, 0.7, 0.4]), (0.6, [0.5, 0.8, 0.9])]);
    let emission = points([(0.0, [0.0; 3]), (0.3, [0.02, 0.01, 0.04]), (0.5, [0.0; 3])]);
    let dark = medium(extinction.clone(), albedo.clone(), Vec::new());
    let shining = medium(extinction, albedo, emission);
    let light = PathTracing {
        samples: 64,
        bounces: Some(1),
        phase: Phase::HenyeyGreenstein(0.4),
        lights: vec![light(dvec3(1.0, 2.0, 0.5))],
        ..PathTracing::default()
    };
    let of = |function, settings: &Settings| -> _ {
        let scene: Scene = scene(&volume, function, &camera, settings, [60, 50]);
        drawn(&scene)
    };
    let paths = |function, bounces| {
        let path = PathTracing {
            bounces: Some(bounces),
            ..light.clone()
        };
        let settings = Settings {
            technique: Technique::Pathtrace,
            path,
            ..Settings::default()
        };
        of(function, &settings)
    };
    let (once, straight) = (paths(&dark, 1), paths(&shining, 0));
    let [few, many] = [1.0, 2.0].map(|samples_per_voxel| {
        let settings = Settings {
            samples_per_voxel,
            rays_per_side: 2,
            ..single(SingleScattering::March, light.clone())
        };
        of(&shining, &settings)
    });
    for channel in 0..3 {
        let [[a, of_a], [b, of_b], [few, _], [many, _]] =
            [&once, &straight, &few, &many].map(|picture| mean_of(picture, channel));
        let (wanted, error, of_steps) = (a + b, of_a.hypot(of_b), (few - many).abs());
        println!("{channel}: {many} by rays ({few} by half), {a} + {b} +- {error} by paths");
        assert!(b > 0.1 * a, "{channel}: {b} of {a}");
        assert!(error < 0.01 * wanted && of_steps < 0.01 * wanted);
        assert!((many - wanted).abs() < 4.0 * error + of_steps, "{channel}");
    }
}
