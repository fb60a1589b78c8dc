//! What estimators say not only in the mean, and units: variances of trackers, turned and scaled worlds.

use super::{
    around_blobs, assert_near, blobs, drawn, eye, layer, light, lit, matter, mean, mean_of, scene,
    settings,
};
use crate::driver_faults::{DARK_FAULT, alone, faulty, tell, told};
use crate::shared::device;
use glam::{DAffine3, DVec3, dvec3};
use std::f64::consts::FRAC_PI_2;
use stratavox::gpu::{DeviceChoice, Headless, Options, PipelineCache, Validation};
use stratavox::offscreen::Renderer;
use stratavox::picture::Picture;
use stratavox::technique::pathtrace::PathTracing;
use stratavox::technique::{Light, LightSpace, Settings};

const SIDE: u32 = 256;

/// The second moment of a channel over pixels, and the correlation of pixels beside each other.
fn second_moment(picture: &Picture, channel: usize) -> [f64; 2] {
    let numbers: Vec<_> = picture
        .pixels
        .iter()
        .map(|p| f64::from(p[channel]))
        .collect();
    let n = numbers.len() as f64;
    let [mean, _] = mean(picture, channel);
    let variance = numbers.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n;
    let beside = numbers
        .windows(2)
        .map(|pair| (pair[0] - mean) * (pair[1] - mean));
    let correlation = beside.sum::<f64>() / (n - 1.0) / variance;
    [numbers.iter().map(|x| x * x).sum::<f64>() / n, correlation]
}

/// Woodcock et al. 1965: of a path 1 or 0 comes through, whatever the majorant; Novak, Selle and Jarosz 2014: along the way to a light a
/// product of 1 - sigma / m, whose second moment is E[(1 - r)^2k], k of Poisson's law of m t, until roulette takes over under .1.
#[test]
fn trackers_have_the_variance_of_their_laws_and_neighbours_nothing_in_common() {
    let (depth, times) = (1.2, 4.0);
    // The majorant is four times the extinction: a value that no voxel has is so dense.
    let function = matter(
        [1.0; 3],
        &[(0.0, depth), (1.0, depth), (2.0, times * depth)],
    );
    let (volume, camera) = (layer(|_| 0.5), eye(DVec3::Z));
    let settings = Settings {
        skip: false,
        ..settings(PathTracing {
            samples: 1,
            bounces: Some(1),
            lights: vec![light(DVec3::Z)],
            ..PathTracing::default()
        })
    };
    let picture = drawn(&scene(&volume, &function, &camera, &settings, [SIDE; 2]));
    let pixels = f64::from(SIDE * SIDE);
    let [met, error] = mean(&picture, 3);
    let chance = -(-depth).exp_m1();
    assert!((met - chance).abs() < 4.0 * error, "{met} {chance}");
    // Of the chance alone: E[1^2] = p.
    let [second, correlation] = second_moment(&picture, 3);
    assert!((second - met).abs() < 1e-6);
    assert!(correlation.abs() < 4.0 / pixels.sqrt(), "{correlation}");
    // A collision at t of the density e^-t brings pi p T = T / 4.
    let r = 1.0 / times;
    let of_count = |k: i32| {
        let first_faint = (0..).find(|&k| (1.0_f64 - r).powi(k) < 0.1).expect("some");
        match k < first_faint {
            true => (1.0 - r).powi(2 * k),
            // What is left is .1 by its own chance, and each null collision behind it leaves it so by 1 - r.
            false => 0.1 * (1.0 - r).powi(k),
        }
    };
    let at_depth = |t: f64| {
        let mean = times * t;
        let mut poisson = (-mean).exp();
        let mut sum = 0.0;
        for k in 0..60 {
            sum += poisson * of_count(k);
            poisson *= mean / f64::from(k + 1);
        }
        sum
    };
    let steps = 2000;
    let parts = (0..steps).map(|i| {
        let t = depth * (f64::from(i) + 0.5) / f64::from(steps);
        (-t).exp() * at_depth(t)
    });
    let wanted = parts.sum::<f64>() * depth / f64::from(steps) / 16.0;
    let [second, correlation] = second_moment(&picture, 0);
    println!("second moment {second:.6}, wanted {wanted:.6}, correlation {correlation:.5}");
    assert!((second / wanted - 1.0).abs() < 0.03, "{second} {wanted}");
    assert!(correlation.abs() < 4.0 / pixels.sqrt(), "{correlation}");
    let [mean, error] = mean(&picture, 0);
    let once = (1.0 - (-2.0 * depth).exp()) / 8.0;
    assert!((mean - once).abs() < 4.0 * error, "{mean} {once}");
}

/// Half as long and twice as dense is the same picture, to the bit: all factors are powers of two.
#[test]
fn half_the_length_at_twice_the_density_is_the_same_picture() {
    let function = matter([0.9, 0.7, 0.4], &[(0.1, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    let seen = [1.0, 0.5].map(|scale| {
        let mut volume = blobs();
        volume.world_from_voxel =
            DAffine3::from_scale(DVec3::splat(scale)) * volume.world_from_voxel;
        let mut camera = around_blobs();
        (camera.eye, camera.target) = (scale * camera.eye, scale * camera.target);
        let settings = settings(PathTracing {
            density: 1.0 / scale,
            ..lit()
        });
        drawn(&scene(&volume, &function, &camera, &settings, [60, 50]))
    });
    assert!(seen[0].pixels.iter().any(|p| p[3] > 0.5));
    assert!(seen[0].pixels == seen[1].pixels);
}

/// Volume, lights and camera turned together by a quarter: other axes, the same light in the mean.
#[test]
fn a_turned_world_is_as_bright() {
    let function = matter([0.9, 0.7, 0.4], &[(0.1, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    let axis = dvec3(0.0, 0.0, 1.0);
    let seen = [0.0, FRAC_PI_2].map(|angle| {
        let turn = DAffine3::from_axis_angle(axis, angle);
        let mut volume = blobs();
        volume.world_from_voxel = turn * volume.world_from_voxel;
        let mut camera = around_blobs();
        camera.eye = turn.transform_point3(camera.eye);
        camera.target = turn.transform_point3(camera.target);
        camera.up = turn.transform_vector3(camera.up);
        let turned = |light: &Light| Light {
            towards: turn.transform_vector3(light.towards),
            space: LightSpace::World,
            srgb: light.srgb,
        };
        let settings = settings(PathTracing {
            samples: 32,
            lights: lit().lights.iter().map(turned).collect(),
            ..lit()
        });
        drawn(&scene(&volume, &function, &camera, &settings, [60, 50]))
    });
    for channel in 0..4 {
        let [[a, of_a], [b, of_b]] = [0, 1].map(|i| mean_of(&seen[i], channel));
        let error = of_a.hypot(of_b);
        assert!((a - b).abs() < 4.0 * error, "{channel}: {a} {b} +- {error}");
        assert!(error < 0.02 * a, "{channel}: {error} of {a}");
    }
}

/// Colours know nothing of each other: a function of permuted albedos makes the permuted picture, to the bit.
#[test]
fn permuted_colours_are_a_permuted_picture() {
    let camera = around_blobs();
    let volume = blobs();
    let seen = [[0.9, 0.7, 0.4], [0.4, 0.9, 0.7]].map(|albedo| {
        let function = matter(albedo, &[(0.1, 0.0), (0.4, 1.5), (1.0, 0.2)]);
        let settings = settings(PathTracing {
            sky: [0.4; 3],
            ..lit()
        });
        drawn(&scene(&volume, &function, &camera, &settings, [60, 50]))
    });
    for (&[r, g, b, a], other) in seen[0].pixels.iter().zip(&seen[1].pixels) {
        assert_eq!([b, r, g, a], *other);
    }
}

/// Light from behind a layer of depth D that is scattered once to the eye before it goes through all of it, L = D e^-D / 4, and as
/// much of it by ways to the light of any depth: a shader that lets none through where less than a tenth would come is found by it.
#[test]
fn light_from_behind_a_deep_layer_comes_through() {
    let (depth, times, density) = (6.0, 4.0, 3.0);
    // Null collisions are three of four: a value that no voxel has is four times as dense.
    let extinction = depth / density;
    let points = [
        (0.0, extinction),
        (1.0, extinction),
        (2.0, times * extinction),
    ];
    let function = matter([1.0; 3], &points);
    let (volume, camera) = (layer(|_| 0.5), eye(DVec3::Z));
    let settings = Settings {
        skip: false,
        ..settings(PathTracing {
            samples: 32,
            bounces: Some(1),
            density,
            lights: vec![light(-DVec3::Z)],
            ..PathTracing::default()
        })
    };
    let scene = scene(&volume, &function, &camera, &settings, [48; 2]);
    let found = |device| {
        let mut renderer = Renderer::new(device, &volume).expect("a renderer");
        mean(&renderer.render(&scene, &[]).expect("drawn").picture, 0)
    };
    let wanted = 0.25 * depth * (-depth).exp();
    assert_near("from behind", found(device()), wanted);
    let options = Options {
        pipeline_cache: PipelineCache::Off,
        validation: Validation::Off,
        ..Options::default()
    };
    let _alone = alone();
    // SAFETY: its functions are Vulkan's, but for shaders that are others.
    let with_fault = unsafe { Headless::through(faulty, &DeviceChoice::Default, &options) };
    tell(Some(DARK_FAULT));
    let [dark, error] = found(with_fault.expect("a device"));
    assert!(told() > 0, "no shader has it");
    tell(None);
    assert!(
        dark < wanted - 8.0 * error,
        "{dark} +- {error}, not {wanted}"
    );
}
