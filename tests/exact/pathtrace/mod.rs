//! Random paths against answers of radiative transfer. Numbers are drawn from fixed seeds: a test that passes once passes
//! for ever. SE: the standard error of a mean.

mod camera;
mod chandrasekhar;
mod gradients;
mod isosurfaces;
mod lamps;
mod layers;
pub mod medium;
mod noise;
mod sky;
mod surfaces;
mod trackers;

use crate::shared::{device, volume_of};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::color::encode_srgb;
use stratavox::offscreen::{self, Renderer};
use stratavox::picture::{LayerKind, Picture};
use stratavox::scene::{Beside, Scene};
use stratavox::technique::pathtrace::{Lamp, LampShape, Lens, PathTracing, Phase, SkyPicture};
use stratavox::technique::{ClipPlane, Filter, Light, LightSpace, Settings, Technique};
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use stratavox::volume::{Rescale, Volume, Voxels};

/// Matter of one albedo, with extinctions per world length at values.
pub fn matter(albedo: [f64; 3], extinctions: &[(f64, f64)]) -> TransferFunction {
    let opacity = |&(value, extinction): &(f64, f64)| OpacityPoint {
        value,
        opacity: -(-extinction).exp_m1(),
    };
    TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: albedo.map(encode_srgb),
        }],
        opacity: extinctions.iter().map(opacity).collect(),
        reference_length: Some(1.0),
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

/// A layer one unit thick, so wide that nothing leaves by its sides.
pub fn layer(value_at: impl Fn(f64) -> f64) -> Volume {
    const THICK: u32 = 8;
    let scale = dvec3(1e4, 1e4, 1.0 / f64::from(THICK));
    let place = DAffine3::from_translation(dvec3(-1e4, -1e4, -1.0)) * DAffine3::from_scale(scale);
    volume_of([2, 2, THICK], place, |p| value_at(p.z / f64::from(THICK)))
}

/// A direction at this cosine to the normal of the layer, at an angle around it.
pub fn at(cosine: f64, turn: f64) -> DVec3 {
    let sine = (1.0 - cosine * cosine).sqrt();
    dvec3(sine * turn.cos(), sine * turn.sin(), cosine)
}

/// From so far above the layer, parallel rays.
pub fn eye(towards: DVec3) -> Camera {
    Camera {
        eye: 3.0 * towards,
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Orthographic { view_height: 1.0 },
        zoom: 1.0,
    }
}

pub fn light(towards: DVec3) -> Light {
    Light {
        towards,
        space: LightSpace::World,
        srgb: [1.0; 3],
    }
}

pub fn settings(path: PathTracing) -> Settings {
    Settings {
        technique: Technique::Pathtrace,
        path,
        ..Settings::default()
    }
}

pub fn scene<'a>(
    volume: &'a Volume,
    function: &'a TransferFunction,
    camera: &'a Camera,
    settings: &'a Settings,
    extent_pixels: [u32; 2],
) -> Scene<'a> {
    Scene {
        volume,
        transfer: Some(function),
        beside: Beside::Nothing,
        camera,
        extent_pixels,
        settings,
    }
}

pub fn drawn(scene: &Scene) -> Picture {
    drawn_with(scene, &[])
}

pub fn drawn_with(scene: &Scene, layers: &[LayerKind]) -> Picture {
    let mut renderer = Renderer::several(device(), scene.volumes()).expect("a renderer");
    renderer.render(scene, layers).expect("a picture").picture
}

/// What paths leave beside their picture.
pub const LAYERS: [LayerKind; 8] = [
    LayerKind::Albedo,
    LayerKind::Normal,
    LayerKind::Depth,
    LayerKind::Direct,
    LayerKind::Indirect,
    LayerKind::Emission,
    LayerKind::Bounces,
    LayerKind::Samples,
];

/// The numbers of a layer.
pub fn numbers(picture: &Picture, kind: LayerKind) -> &[f32] {
    let mut layers = picture.layers.iter();
    let layer = layers.find(|layer| layer.kind == kind);
    &layer.unwrap_or_else(|| panic!("no layer {kind:?}")).values
}

/// Mean and standard error of a channel over the pixels of a picture.
pub fn mean(picture: &Picture, channel: usize) -> [f64; 2] {
    let n = picture.pixels.len() as f64;
    let numbers = || picture.pixels.iter().map(|p| f64::from(p[channel]));
    let mean = numbers().sum::<f64>() / n;
    let variance = numbers().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
    [mean, (variance / n).sqrt()]
}

/// Within four standard errors, of which none is large.
pub fn assert_near(what: &str, [found, error]: [f64; 2], wanted: f64) {
    assert!(error < 0.02 * wanted, "{what}: {error} of {wanted}");
    let off = (found - wanted) / error.max(1e-12);
    assert!(
        off.abs() <= 4.0,
        "{what}: {found} +- {error}, wanted {wanted}"
    );
    println!("{what}: {found:.5} +- {error:.5}, wanted {wanted:.5}");
}

/// A layer of optical depth `depth` seen from a cosine.
fn radiance(path: PathTracing, depth: f64, cosine: f64) -> [f64; 2] {
    // Opacities hold 8 at most: denser matter is scaled.
    let scaled = depth / 8.0_f64.min(depth);
    // What is not seen gives the volume macro cells, and each a majorant of its own.
    let extinction = depth / scaled;
    let function = matter(
        [1.0; 3],
        &[(0.0, 0.0), (0.5, extinction), (1.0, extinction)],
    );
    let settings = settings(PathTracing {
        density: scaled,
        ..path
    });
    let (volume, camera) = (layer(|_| 1.0), eye(at(cosine, 0.0)));
    let scene = scene(&volume, &function, &camera, &settings, [48; 2]);
    mean(&drawn(&scene), 0)
}

/// Chandrasekhar 1950: light scattered once by a layer, L = albedo pi p(c) mu0 / (mu + mu0) (1 - e^(-depth (1/mu + 1/mu0))).
#[test]
fn light_scattered_once_by_a_layer_has_its_closed_form() {
    let (albedo, depth) = (0.8, 1.92);
    for (cosine, cosine_of_light, turn, phase) in [
        (0.5, 0.7, 2.0, Phase::Isotropic),
        (1.0, 0.4, 0.0, Phase::Rayleigh),
        (0.5, 0.7, 0.3, Phase::HenyeyGreenstein(0.6)),
        (0.6, 0.8, 2.5, Phase::HenyeyGreenstein(-0.7)),
    ] {
        let to_light = at(cosine_of_light, turn);
        let path = PathTracing {
            samples: 16,
            bounces: Some(1),
            albedo,
            phase,
            lights: vec![light(to_light)],
            ..PathTracing::default()
        };
        let found = radiance(path, depth, cosine);
        // Of travel: from the eye into the layer, and on to the light.
        let c = -at(cosine, 0.0).dot(to_light);
        let density = match phase {
            Phase::Isotropic => 0.25,
            Phase::Rayleigh => 3.0 * (1.0 + c * c) / 16.0,
            Phase::HenyeyGreenstein(g) => {
                (1.0 - g * g) / (4.0 * (1.0 + g * g - 2.0 * g * c).powf(1.5))
            }
            Phase::TwoLobes { .. } => unreachable!("none is here"),
        };
        let (mu, mu0) = (cosine, cosine_of_light);
        let lost = 1.0 - (-depth * (1.0 / mu + 1.0 / mu0)).exp();
        let wanted = albedo * density * mu0 / (mu + mu0) * lost;
        assert_near(&format!("{phase:?}"), found, wanted);
    }
}

/// van de Hulst 1980, and adding and doubling: what a layer under an even sky sends to the eye is R + T without what comes
/// straight through.
#[test]
fn layers_under_an_even_sky_reflect_and_transmit_what_tables_say() {
    for (depth, albedo, g, cosine, reflected, transmitted) in [
        (2.0, 0.9, 0.75, 1.0, 0.09739, 0.66096),
        (1.0, 0.8, 0.0, 1.0, 0.21085, 0.54140),
        (4.0, 0.95, 0.5, 1.0, 0.35317, 0.33905),
        (4.0, 0.95, 0.5, 0.5, 0.49395, 0.21124),
        (16.0, 0.999, 0.85, 1.0, 0.53978, 0.42559),
    ] {
        let path = PathTracing {
            samples: 16,
            albedo,
            phase: Phase::HenyeyGreenstein(g),
            sky: [1.0; 3],
            ..PathTracing::default()
        };
        let found = radiance(path, depth, cosine);
        let wanted = reflected + transmitted - (-depth / cosine).exp();
        assert_near(&format!("{depth} {albedo} {g} {cosine}"), found, wanted);
    }
}

/// Where there is no data, and outside of a crop box and clip planes, is nothing: for the eye and for light.
#[test]
fn what_is_cut_away_and_what_has_no_data_lets_light_through() {
    let (mu, mu0, depth, left) = (0.6_f64, 0.8, 3.0, 0.5);
    let lost = 1.0 - (-depth * left * (1.0 / mu + 1.0 / mu0)).exp();
    let wanted = 0.25 * mu0 / (mu + mu0) * lost;
    let camera = eye(at(mu, 0.0));
    let function = matter([1.0; 3], &[(0.0, 0.0), (0.5, depth), (1.0, depth)]);
    let whole = layer(|_| 1.0);
    let mut holes = whole.clone();
    holes.validity = Some((0..32).map(|i| u8::from(i < 16)).collect());
    let path = || {
        settings(PathTracing {
            samples: 16,
            bounces: Some(1),
            lights: vec![light(at(mu0, 2.0))],
            ..PathTracing::default()
        })
    };
    let nearest = Settings {
        filter: Filter::Nearest,
        ..path()
    };
    let cropped = Settings {
        crop: Some([DVec3::ZERO, dvec3(2.0, 2.0, 4.0)]),
        ..path()
    };
    let clipped = Settings {
        clip_planes: vec![ClipPlane {
            normal: -DVec3::Z,
            offset: left,
        }],
        ..path()
    };
    for (name, volume, settings) in [
        ("no data", &holes, nearest),
        ("crop", &whole, cropped),
        ("clip", &whole, clipped),
    ] {
        let scene = scene(volume, &function, &camera, &settings, [48; 2]);
        assert_near(name, mean(&drawn(&scene), 0), wanted);
    }
}

/// A light as wide as a cap of the sky gives what the mean over the cap gives.
#[test]
fn a_wide_light_is_the_mean_of_its_directions() {
    let (mu, depth, degrees) = (0.6, 2.0, 60.0_f64);
    let path = PathTracing {
        samples: 16,
        bounces: Some(1),
        lights: vec![light(DVec3::Z)],
        light_size_degrees: degrees,
        ..PathTracing::default()
    };
    let found = radiance(path, depth, mu);
    let least = (0.5 * degrees).to_radians().cos();
    let of = |mu0: f64| 0.25 * mu0 / (mu + mu0) * (1.0 - (-depth * (1.0 / mu + 1.0 / mu0)).exp());
    let parts = (0..1000).map(|i| of(least + (1.0 - least) * (f64::from(i) + 0.5) / 1000.0));
    assert_near("cap", found, parts.sum::<f64>() / 1000.0);
}

/// Blobs in a box whose voxels are no cubes.
pub fn blobs() -> Volume {
    let place = DAffine3::from_scale(dvec3(1.0, 0.8, 1.3));
    volume_of([40, 36, 28], place, |p| {
        ((0.2 * p.x).sin() + (0.25 * p.y + 1.0).sin() + (0.22 * p.z).cos()) / 3.0
    })
}

/// The same in whole numbers up to `most`, from -1 to 1.
fn of_codes(volume: &Volume, most: u16) -> Volume {
    let Voxels::F32(values) = &volume.voxels else {
        unreachable!("it is made of floats");
    };
    let codes = values
        .iter()
        .map(|v| (0.5 * (v + 1.0) * f32::from(most)).round());
    let voxels = match most {
        255 => Voxels::U8(codes.map(|code| code as u8).collect()),
        _ => Voxels::U16(codes.map(|code| code as u16).collect()),
    };
    let rescale = Rescale {
        slope: 2.0 / f64::from(most),
        intercept: -1.0,
    };
    Volume::from_voxels(volume.dims, volume.world_from_voxel, voxels, rescale, None)
        .expect("a volume")
}

pub fn around_blobs() -> Camera {
    Camera {
        eye: dvec3(70.0, 50.0, 60.0),
        target: dvec3(20.0, 14.0, 18.0),
        up: DVec3::Y,
        projection: Projection::Perspective { fov_degrees: 40.0 },
        zoom: 1.0,
    }
}

/// White matter in a white sky cannot be told from it: each path brings 1, to the bit.
#[test]
fn white_matter_in_an_even_sky_is_as_bright_as_the_sky() {
    let (volume, camera) = (blobs(), around_blobs());
    let function = matter([1.0; 3], &[(0.0, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    for (phase, surface) in [
        (Phase::Isotropic, 0.0),
        (Phase::HenyeyGreenstein(0.9), 0.0),
        (Phase::Rayleigh, 3.0),
    ] {
        let settings = Settings {
            clip_planes: vec![ClipPlane {
                normal: dvec3(1.0, 0.3, 0.2),
                offset: 15.0,
            }],
            ..settings(PathTracing {
                samples: 4,
                phase,
                surface,
                sky: [1.0; 3],
                ..PathTracing::default()
            })
        };
        let scene = scene(&volume, &function, &camera, &settings, [60, 50]);
        let reference = offscreen::reference::render::<f64>(&scene).expect("a picture");
        let pictures = [drawn(&scene), reference];
        for picture in pictures {
            let met = picture.pixels.iter().filter(|pixel| pixel[3] > 0.0);
            assert!(met.clone().count() > 500);
            for &[r, g, b, alpha] in met {
                assert_eq!([r, g, b], [alpha; 3], "{phase:?}");
            }
        }
    }
}

pub fn lit() -> PathTracing {
    PathTracing {
        samples: 4,
        albedo: 0.9,
        phase: Phase::TwoLobes {
            part: 0.6,
            g: [0.7, -0.3],
        },
        surface: 2.0,
        sky: [0.2, 0.3, 0.5],
        lights: vec![light(dvec3(1.0, 2.0, 0.5)), light(dvec3(-1.0, 0.2, 1.0))],
        light_size_degrees: 8.0,
        ..PathTracing::default()
    }
}

/// Path by path: the same random numbers make the same collisions, but where rounding turns a choice. Of voxels of 8 and 16
/// bits a driver on the processor reads footprints, which paths go through by other words.
#[test]
fn the_shader_traces_the_paths_of_its_reference() {
    let floats = blobs();
    let camera = around_blobs();
    let function = matter([0.9, 0.7, 0.4], &[(0.0, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    let coated = PathTracing {
        f0: 0.3,
        roughness: 0.5,
        lens: Some(Lens {
            radius: 2.0,
            focus: Some(60.0),
        }),
        ..lit()
    };
    let pixels: Vec<_> = (0..32)
        .map(|i| [0.2, 0.1 + 0.05 * (i % 7) as f32, 0.3])
        .collect();
    let under_a_picture = PathTracing {
        sky: [1.0; 3],
        sky_picture: Some(SkyPicture::new([8, 4], &pixels).expect("a sky")),
        shows_sky: true,
        ..coated.clone()
    };
    let by_lamps = PathTracing {
        lights: Vec::new(),
        lamps: vec![
            Lamp {
                place: dvec3(30.0, 40.0, 10.0),
                shape: LampShape::Sphere { radius: Some(9.0) },
                srgb: [1.0, 0.8, 0.6],
            },
            Lamp {
                place: dvec3(45.0, -3.0, 30.0),
                shape: LampShape::Disc { radius: 12.0 },
                srgb: [0.4, 0.8, 1.0],
            },
        ],
        ..lit()
    };
    for (name, volume, path, conformance) in [
        ("f32", floats.clone(), lit(), true),
        ("coated, by a lens", floats.clone(), coated, true),
        ("by lamps", floats.clone(), by_lamps, true),
        ("under a picture", floats.clone(), under_a_picture, true),
        ("u8", of_codes(&floats, u8::MAX.into()), lit(), false),
        ("u16", of_codes(&floats, u16::MAX), lit(), false),
    ] {
        let settings = Settings {
            // Cells change which numbers are drawn.
            skip: false,
            conformance,
            ..settings(path)
        };
        let scene = scene(&volume, &function, &camera, &settings, [60, 50]);
        assert_same_paths(name, &scene, 1000);
    }
}

/// Path by path, on the device and by its reference in f32, of which at least so many pixels meet something.
fn assert_same_paths(name: &str, scene: &Scene, least_met: usize) {
    let picture = drawn_with(scene, &LAYERS);
    let reference = offscreen::reference::render::<f32>(scene).expect("a picture");
    let pairs = || picture.pixels.iter().zip(&reference.pixels);
    let conformance = scene.settings.conformance;
    // The table of a function has steps of 1/4095 of its range.
    let bound = if conformance { 1e-3 } else { 3e-3 };
    let mut parted: Vec<bool> = pairs()
        .map(|(a, b)| (0..4).any(|c| (a[c] - b[c]).abs() > bound))
        .collect();
    for kind in LAYERS {
        let both = [&picture, &reference].map(|picture| numbers(picture, kind));
        let n = both[0].len() / parted.len();
        for (i, (&a, &b)) in both[0].iter().zip(both[1]).enumerate() {
            // Depths are some 60 long.
            let is_near = (a - b).abs() <= bound * b.abs().max(1.0);
            let are_both_none = a.is_nan() && b.is_nan();
            parted[i / n] |= !(is_near || are_both_none);
        }
    }
    let parted = parted.into_iter().filter(|&parted| parted);
    let share = parted.count() as f64 / picture.pixels.len() as f64;
    println!("{name}: {share} of the pixels have a path that parts");
    // Of each path 0.2 % at most, and as many again where choices are by a table; a pixel has four.
    let most = if conformance { 0.008 } else { 0.016 };
    assert!(share < most, "{name}: {share}");
    let met = pairs().filter(|(a, _)| a[3] > 0.0).count();
    assert!(met > least_met, "{name}: {met}");
}

#[test]
fn empty_space_changes_paths_and_no_mean() {
    let (volume, camera) = (blobs(), around_blobs());
    let function = matter([0.9, 0.7, 0.4], &[(0.1, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    let pictures = [true, false].map(|skip| {
        let settings = Settings {
            skip,
            ..settings(PathTracing {
                samples: 16,
                ..lit()
            })
        };
        drawn(&scene(&volume, &function, &camera, &settings, [60, 50]))
    });
    let [skipped, whole] = pictures;
    assert!(skipped.pixels != whole.pixels);
    for channel in 0..4 {
        let [[a, of_a], [b, of_b]] = [mean_of(&skipped, channel), mean_of(&whole, channel)];
        let error = of_a.hypot(of_b);
        assert!((a - b).abs() < 4.0 * error, "{channel}: {a} {b} +- {error}");
        assert!(error < 0.02 * a, "{channel}: {error} of {a}");
    }
}

/// The mean of a picture whose pixels differ: the error by that of neighbours.
pub fn mean_of(picture: &Picture, channel: usize) -> [f64; 2] {
    let numbers: Vec<_> = picture
        .pixels
        .iter()
        .map(|p| f64::from(p[channel]))
        .collect();
    let n = numbers.len() as f64;
    let variance = numbers
        .windows(2)
        .map(|pair| 0.5 * (pair[0] - pair[1]).powi(2));
    let variance = variance.sum::<f64>() / (n - 1.0);
    [numbers.iter().sum::<f64>() / n, (variance / n).sqrt()]
}

/// Pictures of parts of the paths add up, however the work is cut.
#[test]
fn the_picture_does_not_depend_on_how_the_work_is_cut() {
    let (volume, camera) = (blobs(), around_blobs());
    let function = matter([0.9, 0.7, 0.4], &[(0.1, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    let device = device();
    let mut renderer = Renderer::new(device, &volume).expect("a renderer");
    let mut part = |first_sample, samples, seed, ms| {
        renderer.set_submission_ms(ms);
        let settings = settings(PathTracing {
            first_sample,
            samples,
            seed,
            ..lit()
        });
        let scene = scene(&volume, &function, &camera, &settings, [60, 50]);
        let rendered = renderer.render(&scene, &[]).expect("a picture");
        rendered.picture.pixels
    };
    let [all, again, pieces] = [f64::INFINITY, 100.0, 0.0].map(|ms| part(0, 6, 0, ms));
    assert!(all == again && all == pieces);
    let [first, rest] = [part(0, 2, 0, 100.0), part(2, 4, 0, 100.0)];
    for ((all, a), b) in all.iter().zip(&first).zip(&rest) {
        for c in 0..4 {
            let sum = (2.0 * f64::from(a[c]) + 4.0 * f64::from(b[c])) / 6.0;
            assert!((f64::from(all[c]) - sum).abs() < 1e-6);
        }
    }
    assert!(all != part(0, 6, 1, 100.0));
}

/// Without scattering a path brings the colour of its first collision: the composite.
#[test]
fn without_bounces_the_picture_is_the_composite() {
    let (volume, camera) = (blobs(), around_blobs());
    let function = matter([0.9, 0.7, 0.4], &[(0.1, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    let paths = settings(PathTracing {
        samples: 32,
        bounces: Some(0),
        ..PathTracing::default()
    });
    let rays = Settings {
        samples_per_voxel: 16.0,
        rays_per_side: 2,
        ..Settings::default()
    };
    let pictures = [paths, rays]
        .map(|settings| drawn(&scene(&volume, &function, &camera, &settings, [60, 50])));
    let [paths, rays] = pictures;
    for channel in 0..4 {
        // Both at the same pixels: the error is that of the paths, of a pixel sqrt(p (1 - p) / 32) at most.
        let pairs = || paths.pixels.iter().zip(&rays.pixels);
        let n = pairs().count() as f64;
        let off = pairs().map(|(a, b)| f64::from(a[channel] - b[channel]));
        let variance = pairs().map(|(_, b)| f64::from(b[3] * (1.0 - b[3])) / 32.0);
        let (off, error) = (off.sum::<f64>() / n, variance.sum::<f64>().sqrt() / n);
        assert!(off.abs() < 4.0 * error, "{channel}: {off} +- {error}");
        assert!(error < 2e-3);
    }
}
