//! Light that is scattered once, by rays: closed forms of layers and of the sums that rays make of them, and random paths.

mod limits;
mod medium;
mod points;
mod references;

use crate::pathtrace::{around_blobs, at, blobs, drawn, eye, light, matter, mean_of, scene};
use crate::shared::volume_of;
use glam::{DAffine3, DVec3, dvec3};
use stratavox::offscreen::reference;
use stratavox::picture::Picture;
use stratavox::technique::pathtrace::{PathTracing, Phase};
use stratavox::technique::{ClipPlane, Filter, Settings, SingleScattering, Technique};
use stratavox::volume::Volume;

fn single(scattering: SingleScattering, path: PathTracing) -> Settings {
    Settings {
        single_scattering: Some(scattering),
        path,
        ..Settings::default()
    }
}

/// A layer one unit thick, of so many voxels across, and of so many of side 1 to each side that nothing that counts leaves by
/// its sides.
fn layer(voxels: u32, aside: u32) -> Volume {
    let scale = dvec3(1.0, 1.0, 1.0 / f64::from(voxels));
    let corner = dvec3(-f64::from(aside), -f64::from(aside), -1.0);
    let place = DAffine3::from_translation(corner) * DAffine3::from_scale(scale);
    volume_of([2 * aside, 2 * aside, voxels], place, |_| 1.0)
}

/// Farther than rays and light of cosines over 1/4 go aside.
const ASIDE: u32 = 8;

/// What a ray sums of a layer of optical depth `depth` by steps of optical depth `x`, of albedo and phase function 1, with the
/// cosines of eye and light:
///
/// ```text
/// mu0 / (mu + mu0) (1 - e^(-depth (1/mu + 1/mu0)))                              Chandrasekhar 1950
/// e^(-x k/2) (1 - e^-x) (1 + k) / (1 - e^(-x (1 + k)))      k = mu / mu0        times, of samples in the middles of steps
/// ```
fn sum_of_layer(depth: f64, [mu, mu0]: [f64; 2], x: f64) -> f64 {
    let k = mu / mu0;
    let exact = (1.0 - (-depth * (1.0 / mu + 1.0 / mu0)).exp()) / (1.0 + k);
    let of_steps = (-0.5 * x * k).exp() * (1.0 - (-x).exp()) * (1.0 + k);
    exact * of_steps / (1.0 - (-x * (1.0 + k)).exp())
}

/// pi p(c) of c between the directions of travel: from the eye into the layer, and on to the light.
fn scattered_part(phase: Phase, c: f64) -> f64 {
    let lobe = |g: f64| (1.0 - g * g) / (4.0 * (1.0 + g * g - 2.0 * g * c).powf(1.5));
    match phase {
        Phase::Isotropic => 0.25,
        Phase::Rayleigh => 3.0 * (1.0 + c * c) / 16.0,
        Phase::HenyeyGreenstein(g) => lobe(g),
        Phase::TwoLobes { part, g: [g1, g2] } => part * lobe(g1) + (1.0 - part) * lobe(g2),
    }
}

fn is_within(what: &str, picture: &Picture, wanted: f64, part: f64) {
    for pixel in &picture.pixels {
        let found = f64::from(pixel[0]);
        let off = found / wanted - 1.0;
        assert!(
            off.abs() <= part,
            "{what}: {found}, wanted {wanted}: {off:.2e}"
        );
    }
}

/// A whole number of steps of 1/8 lies in the layer, and light comes at any angle.
#[test]
fn rays_sum_what_steps_make_of_light_that_a_layer_scatters_once() {
    let (albedo, depth, density) = (0.8, 1.92, 2.0);
    let volume = layer(8, ASIDE);
    let extinction = depth / density;
    let function = matter(
        [1.0; 3],
        &[(0.0, 0.0), (0.5, extinction), (1.0, extinction)],
    );
    for (mu, mu0, turn, phase) in [
        (0.5, 0.7, 2.0, Phase::Isotropic),
        (1.0, 0.4, 0.0, Phase::Rayleigh),
        (0.5, 0.7, 0.3, Phase::HenyeyGreenstein(0.6)),
        (0.25, 0.8, 2.5, Phase::HenyeyGreenstein(-0.7)),
        (
            0.5,
            0.9,
            1.0,
            Phase::TwoLobes {
                part: 0.3,
                g: [0.8, -0.4],
            },
        ),
    ] {
        let (camera, to_light) = (eye(at(mu, 0.0)), at(mu0, turn));
        let path = PathTracing {
            albedo,
            density,
            phase,
            lights: vec![light(to_light)],
            ..PathTracing::default()
        };
        let part = scattered_part(phase, -at(mu, 0.0).dot(to_light));
        let wanted = albedo * part * sum_of_layer(depth, [mu, mu0], depth / 8.0);
        for conformance in [true, false] {
            let settings = Settings {
                conformance,
                ..single(SingleScattering::March, path.clone())
            };
            let scene = scene(&volume, &function, &camera, &settings, [6, 5]);
            let what = format!("{phase:?}, conformance {conformance}");
            // Some twenty roundings of 6e-8 for each of 32 samples.
            is_within(&what, &drawn(&scene), wanted, 2e-5);
            let f32 = reference::render::<f32>(&scene).expect("a picture");
            is_within(&what, &f32, wanted, 2e-5);
            let f64 = reference::render::<f64>(&scene).expect("a picture");
            // Pictures hold f32, and so do parameters.
            is_within(&what, &f64, wanted, 2e-6);
        }
    }
}

/// The last step of light is as long as what is left of the way: rays whose own last step is short too have the sum of their
/// samples, one by one.
#[test]
fn steps_that_do_not_fit_end_where_the_layer_does() {
    let (depth, mu, mu0, voxels) = (2.4_f64, 0.37, 0.83, 8);
    let volume = layer(voxels, ASIDE);
    let function = matter([1.0; 3], &[(0.0, 0.0), (0.5, depth), (1.0, depth)]);
    let path = PathTracing {
        lights: vec![light(at(mu0, 2.0))],
        ..PathTracing::default()
    };
    let step = 1.0 / f64::from(voxels);
    let whole = (1.0 / mu / step).floor() as u32;
    let rest = 1.0 / mu - f64::from(whole) * step;
    let (mut wanted, mut through) = (0.0, 1.0);
    for k in 0..=whole {
        let (t, length) = match k < whole {
            true => ((f64::from(k) + 0.5) * step, step),
            false => (f64::from(whole) * step + 0.5 * rest, rest),
        };
        let opacity = 1.0 - (-depth * length).exp();
        wanted += 0.25 * through * opacity * (-depth * t * mu / mu0).exp();
        through *= 1.0 - opacity;
    }
    let (camera, settings) = (eye(at(mu, 0.0)), single(SingleScattering::March, path));
    let scene = scene(&volume, &function, &camera, &settings, [6, 5]);
    is_within("rests", &drawn(&scene), wanted, 2e-5);
}

/// In uniform matter optical depths are the same between nodes. Those of nodes are sums of lengths in f32, some hundred of them.
#[test]
fn a_light_volume_gives_what_light_from_each_sample_gives() {
    let (depth, mu, mu0, voxels) = (1.92, 0.5, 0.7, 96);
    // Rays go sqrt(3) aside and light 1.02.
    let volume = layer(voxels, 6);
    let function = matter([1.0; 3], &[(0.0, 0.0), (0.5, depth), (1.0, depth)]);
    let path = PathTracing {
        lights: vec![light(at(mu0, 2.0))],
        ..PathTracing::default()
    };
    let camera = eye(at(mu, 0.0));
    let x = depth / f64::from(voxels);
    let wanted = 0.25 * sum_of_layer(depth, [mu, mu0], x);
    let settings = single(SingleScattering::Volume, path.clone());
    let scene_of_volume = scene(&volume, &function, &camera, &settings, [6, 5]);
    is_within("volume", &drawn(&scene_of_volume), wanted, 5e-5);
    // Nothing in the way: the opacity of the layer.
    let open = single(SingleScattering::Open, path);
    let scene_of_open = scene(&volume, &function, &camera, &open, [6, 5]);
    let wanted = 0.25 * (1.0 - (-depth / mu).exp());
    is_within("open", &drawn(&scene_of_open), wanted, 2e-5);
}

/// E2(t) = integral over mu from 0 to 1 of e^(-t / mu), in the middles of steps.
fn exponential_integral(t: f64) -> f64 {
    let n = 20_000;
    let of = |i: i32| (-t * f64::from(n) / (f64::from(i) + 0.5)).exp();
    (0..n).map(of).sum::<f64>() / f64::from(n)
}

/// A layer under an even sky of 1 scatters, once, albedo / 2 times the integral of e^(-t / mu) (E2(t) + E2(depth - t)) dt / mu.
#[test]
fn an_even_sky_comes_through_from_all_sides() {
    let (depth, albedo, mu) = (1.0, 0.7, 0.6);
    let steps = 400;
    let source = |i: i32| {
        let t = depth * (f64::from(i) + 0.5) / f64::from(steps);
        let sky = exponential_integral(t) + exponential_integral(depth - t);
        0.5 * albedo * sky * (-t / mu).exp() * depth / f64::from(steps) / mu
    };
    let wanted: f64 = (0..steps).map(source).sum();
    assert!((wanted - 0.22513).abs() < 1e-5, "{wanted}");
    // Through the nine units that are left at the sides comes 1e-4.
    let volume = layer(48, 11);
    let function = matter([1.0; 3], &[(0.0, 0.0), (0.5, depth), (1.0, depth)]);
    let path = PathTracing {
        albedo,
        sky: [1.0, 0.5, 0.0],
        ..PathTracing::default()
    };
    let camera = eye(at(mu, 0.0));
    for scattering in [SingleScattering::Volume, SingleScattering::March] {
        let settings = single(scattering, path.clone());
        let scene = scene(&volume, &function, &camera, &settings, [6, 5]);
        for [red, green, blue, _] in drawn(&scene).pixels {
            // 32 directions.
            let off = f64::from(red) - wanted;
            assert!(off.abs() < 1e-3, "{red}, wanted {wanted}");
            assert!((2.0 * green - red).abs() < 1e-6 && blue == 0.0);
        }
    }
}

/// Where there is no data, and outside of a crop box and clip planes, is nothing: for the eye and for light. Steps of light end
/// where the domain does, and count by their middles where there is no data.
#[test]
fn what_is_cut_away_and_what_has_no_data_lets_light_through() {
    let (mu, mu0, depth, left, step) = (0.5, 0.8, 3.0, 0.5, 0.125);
    let wanted = 0.25 * sum_of_layer(depth * left, [mu, mu0], depth * step);
    let counted = (0..8).map(|k| {
        let below = (f64::from(k) + 0.5) * step * mu;
        let steps = (below / (mu0 * step) + 0.5).floor();
        let opacity = 1.0 - (-depth * step).exp();
        0.25 * opacity * (-depth * step * (f64::from(k) + steps)).exp()
    });
    let counted: f64 = counted.sum();
    let camera = eye(at(mu, 0.0));
    let function = matter([1.0; 3], &[(0.0, 0.0), (0.5, depth), (1.0, depth)]);
    let whole = layer(8, ASIDE);
    let mut holes = whole.clone();
    let count = holes.dims.iter().product::<u32>();
    holes.validity = Some((0..count).map(|i| u8::from(2 * i < count)).collect());
    let path = PathTracing {
        lights: vec![light(at(mu0, 2.0))],
        ..PathTracing::default()
    };
    let base = || single(SingleScattering::March, path.clone());
    let nearest = Settings {
        filter: Filter::Nearest,
        ..base()
    };
    let side = f64::from(2 * ASIDE);
    let cropped = Settings {
        crop: Some([DVec3::ZERO, dvec3(side, side, 4.0)]),
        ..base()
    };
    let clipped = Settings {
        clip_planes: vec![ClipPlane {
            normal: -DVec3::Z,
            offset: left,
        }],
        ..base()
    };
    for (name, volume, settings, wanted) in [
        ("no data", &holes, nearest, counted),
        ("crop", &whole, cropped, wanted),
        ("clip", &whole, clipped, wanted),
    ] {
        let scene = scene(volume, &function, &camera, &settings, [6, 5]);
        is_within(name, &drawn(&scene), wanted, 2e-5);
    }
}

/// Paths of one bounce are random, rays have steps: how much these matter, half as many say.
#[test]
fn paths_of_one_bounce_have_the_mean_of_rays() {
    let (volume, camera) = (blobs(), around_blobs());
    let function = matter([0.9, 0.7, 0.4], &[(0.1, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    let medium = PathTracing {
        samples: 64,
        bounces: Some(1),
        albedo: 0.9,
        density: 0.5,
        phase: Phase::HenyeyGreenstein(0.4),
        lights: vec![light(dvec3(1.0, 2.0, 0.5)), light(dvec3(-1.0, 0.2, 1.0))],
        ..PathTracing::default()
    };
    let of = |settings: Settings| drawn(&scene(&volume, &function, &camera, &settings, [60, 50]));
    let paths = of(Settings {
        technique: Technique::Pathtrace,
        path: medium.clone(),
        ..Settings::default()
    });
    let [few, many] = [1.0, 2.0].map(|samples_per_voxel| {
        of(Settings {
            samples_per_voxel,
            rays_per_side: 2,
            ..single(SingleScattering::March, medium.clone())
        })
    });
    for channel in 0..3 {
        let [[wanted, error], [few, _], [many, _]] =
            [&paths, &few, &many].map(|picture| mean_of(picture, channel));
        let of_steps = (few - many).abs();
        println!("{channel}: {many} by rays ({few} by half), {wanted} +- {error} by paths");
        assert!(error < 0.01 * wanted && of_steps < 0.01 * wanted);
        assert!((many - wanted).abs() < 4.0 * error + of_steps, "{channel}");
    }
}
