//! Solid surfaces of values, and matter beside them.

use super::{
    around_blobs, assert_near, assert_same_paths, at, blobs, drawn, eye, layer, light, lit, matter,
    mean, mean_of, numbers, of_codes, scene, settings,
};
use crate::driver_faults::{GRAZING_FAULT, alone, faulty, tell, told};
use crate::shared::{device, volume_of};
use glam::{DAffine3, DQuat, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::color::{decode_srgb, encode_srgb};
use stratavox::gpu::{DeviceChoice, Headless, Options, PipelineCache, Validation};
use stratavox::offscreen::{self, Renderer};
use stratavox::picture::LayerKind;
use stratavox::technique::pathtrace::PathTracing;
use stratavox::technique::{Filter, Level, PerMode, Settings};

/// Levels of a value, an albedo and an opacity.
pub fn with_levels(path: PathTracing, levels: &[(f64, [f64; 3], f64)]) -> Settings {
    let level = |&(value, albedo, opacity): &(f64, [f64; 3], f64)| Level {
        value,
        srgb: albedo.map(encode_srgb),
        opacity,
    };
    Settings {
        per_mode: PerMode {
            levels: levels.iter().map(level).collect(),
            ..PerMode::default()
        },
        ..settings(path)
    }
}

/// In vacuum under a light from afar each path brings albedo n . l: nothing is left to chance. Of the reference and of the
/// device, on grids at right angles and oblique ones, and of the faces of voxels.
#[test]
fn a_plane_is_as_bright_as_the_cosine_to_the_light() {
    let vacuum = matter([1.0; 3], &[(0.0, 0.0)]);
    let oblique = DAffine3::from_rotation_translation(
        DQuat::from_axis_angle(dvec3(1.0, 2.0, -0.5).normalize(), 0.7),
        dvec3(-7.0, -4.0, -3.0),
    ) * DAffine3::from_scale(dvec3(1.0, 0.7, 1.4));
    let slope = dvec3(0.3, -0.2, 0.5);
    let tilted = volume_of([14, 15, 10], oblique, |p| p.dot(slope));
    let middle = dvec3(7.0, 7.5, 5.0);
    let across = oblique.matrix3.inverse().transpose() * slope;
    let at_middle = oblique.transform_point3(middle);
    let towards = (across.normalize() + dvec3(0.3, 0.1, -0.2)).normalize();
    let facing = Camera {
        eye: at_middle + 3.0 * towards,
        target: at_middle,
        ..eye(DVec3::Z)
    };
    let way = (across.normalize() + dvec3(-0.5, 0.4, 0.3)).normalize();
    let of_layer = (layer(|z| z), eye(at(0.6, 0.3)), 0.5, at(0.8, 2.0), 0.8);
    let of_tilted = (
        tilted,
        facing,
        middle.dot(slope),
        way,
        across.normalize().dot(way),
    );
    for ((volume, camera, value, to_light, cosine), filter) in [
        (&of_layer, Filter::Linear),
        (&of_layer, Filter::Nearest),
        (&of_tilted, Filter::Linear),
    ] {
        let path = PathTracing {
            samples: 2,
            lights: vec![light(*to_light)],
            ..PathTracing::default()
        };
        let settings = Settings {
            filter,
            ..with_levels(path, &[(*value, [0.8, 0.5, 0.2], 1.0)])
        };
        let scene = scene(volume, &vacuum, camera, &settings, [16; 2]);
        let reference = offscreen::reference::render::<f64>(&scene).expect("a picture");
        for picture in [reference, drawn(&scene)] {
            for pixel in picture.pixels {
                for (found, albedo) in pixel.into_iter().zip([0.8, 0.5, 0.2]) {
                    let wanted = decode_srgb(encode_srgb(albedo)) * cosine;
                    let off = (f64::from(found) - wanted).abs();
                    assert!(off < 1e-5, "{filter:?}: {found}, wanted {wanted}");
                }
                assert_eq!(pixel[3], 1.0);
            }
        }
    }
}

/// Along the diagonal of a cell whose corners have 0, 1, 0 and 1 the value is 2 s (1 - s): a level of .4 is entered and left
/// in that cell, at s = (1 -+ sqrt(.2)) / 2. Ends of the cell alone do not tell, which is injected as a fault.
#[test]
fn a_surface_that_a_way_enters_and_leaves_in_one_cell_is_met() {
    let volume = volume_of([2; 3], DAffine3::IDENTITY, |p| {
        f64::from((p.x < 1.0) != (p.y < 1.0))
    });
    let vacuum = matter([1.0; 3], &[(0.0, 0.0)]);
    let camera = Camera {
        eye: dvec3(-2.0, -2.0, 1.0),
        target: DVec3::ONE,
        up: DVec3::Z,
        projection: Projection::Orthographic { view_height: 1e-4 },
        zoom: 1.0,
    };
    let path = PathTracing {
        samples: 2,
        lights: vec![light(dvec3(-1.0, -1.0, 0.5))],
        ..PathTracing::default()
    };
    let settings = with_levels(path, &[(0.4, [1.0; 3], 1.0)]);
    let scene = scene(&volume, &vacuum, &camera, &settings, [8; 2]);
    let depths = |device| {
        let mut renderer = Renderer::new(device, &volume).expect("a renderer");
        let found = renderer.render(&scene, &[LayerKind::Depth]).expect("drawn");
        numbers(&found.picture, LayerKind::Depth).to_vec()
    };
    let near = 2_f64.sqrt() * (2.5 + 0.5 * (1.0 - 0.2_f64.sqrt()));
    for found in depths(device()) {
        let off = (f64::from(found) - near).abs();
        assert!(off < 1e-4, "{found}, wanted {near}");
    }
    let options = Options {
        pipeline_cache: PipelineCache::Off,
        validation: Validation::Off,
        ..Options::default()
    };
    let _alone = alone();
    // SAFETY: its functions are Vulkan's, but for shaders that are others.
    let with_fault = unsafe { Headless::through(faulty, &DeviceChoice::Default, &options) };
    tell(Some(GRAZING_FAULT));
    let missed = depths(with_fault.expect("a device"));
    assert!(told() > 0, "no shader has it");
    tell(None);
    assert!(missed.iter().all(|depth| depth.is_nan()), "{missed:?}");
}

/// White surfaces in a white sky, with white matter around, cannot be told from it: each path brings 1, to the bit.
#[test]
fn white_surfaces_in_an_even_sky_are_as_bright_as_the_sky() {
    let (volume, camera) = (blobs(), around_blobs());
    let function = matter([1.0; 3], &[(0.0, 0.0), (0.4, 0.3), (1.0, 0.2)]);
    for (filter, skip) in [
        (Filter::Linear, true),
        (Filter::Linear, false),
        (Filter::Nearest, true),
    ] {
        let path = PathTracing {
            samples: 4,
            surface: 1.0,
            sky: [1.0; 3],
            ..PathTracing::default()
        };
        let settings = Settings {
            filter,
            skip,
            ..with_levels(path, &[(0.5, [1.0; 3], 1.0), (0.2, [1.0; 3], 0.4)])
        };
        let scene = scene(&volume, &function, &camera, &settings, [40, 36]);
        let reference = offscreen::reference::render::<f64>(&scene).expect("a picture");
        for picture in [reference, drawn(&scene)] {
            let met = picture.pixels.iter().filter(|pixel| pixel[3] > 0.0);
            assert!(met.clone().count() > 500);
            for &[r, g, b, alpha] in met {
                assert_eq!([r, g, b], [alpha; 3], "{filter:?}");
            }
        }
    }
}

/// Path by path, as other pictures of paths.
#[test]
fn the_shader_meets_the_surfaces_of_its_reference() {
    let floats = blobs();
    let camera = around_blobs();
    let function = matter([0.9, 0.7, 0.4], &[(0.0, 0.0), (0.4, 0.2), (1.0, 0.2)]);
    let coated = PathTracing {
        f0: 0.3,
        roughness: 0.5,
        ..lit()
    };
    let (linear, nearest) = (Filter::Linear, Filter::Nearest);
    for (name, volume, path, filter, conformance) in [
        ("f32", floats.clone(), lit(), linear, true),
        ("coated", floats.clone(), coated, linear, true),
        ("nearest", floats.clone(), lit(), nearest, true),
        (
            "u8",
            of_codes(&floats, u8::MAX.into()),
            lit(),
            linear,
            false,
        ),
        ("u16", of_codes(&floats, u16::MAX), lit(), linear, false),
    ] {
        let settings = Settings {
            // Cells change which numbers are drawn.
            skip: false,
            conformance,
            filter,
            ..with_levels(
                path,
                &[(0.451, [0.9, 0.8, 0.7], 1.0), (0.213, [0.8, 0.3, 0.2], 0.4)],
            )
        };
        let scene = scene(&volume, &function, &camera, &settings, [48, 40]);
        assert_same_paths(name, &scene, 700);
    }
}

/// Two planes one behind the other, under a light from afar: mu0 (o1 + (1 - o1)^2 o2), alpha 1 - (1 - o1) (1 - o2). The
/// faces of voxels may be those of both.
#[test]
fn surfaces_let_through_what_their_opacity_leaves() {
    let vacuum = matter([1.0; 3], &[(0.0, 0.0)]);
    let (near, far, mu0) = (0.3, 0.6, 0.8);
    for (filter, values) in [
        (Filter::Linear, [0.8, 0.3]),
        (Filter::Nearest, [0.8, 0.3]),
        (Filter::Nearest, [0.51, 0.5]),
    ] {
        let (volume, camera) = (layer(|z| z), eye(at(0.6, 0.3)));
        let path = PathTracing {
            samples: 32,
            bounces: Some(1),
            lights: vec![light(at(mu0, 2.0))],
            ..PathTracing::default()
        };
        let settings = Settings {
            filter,
            ..with_levels(
                path,
                &[
                    (values[0], [1.0, 0.0, 1.0], near),
                    (values[1], [0.0, 1.0, 1.0], far),
                ],
            )
        };
        let scene = scene(&volume, &vacuum, &camera, &settings, [48; 2]);
        let picture = drawn(&scene);
        let behind = (1.0 - near) * (1.0 - near) * far;
        let wanted = [near * mu0, behind * mu0, (near + behind) * mu0];
        let alpha = 1.0 - (1.0 - near) * (1.0 - far);
        for (channel, wanted) in wanted.into_iter().chain([alpha]).enumerate() {
            let name = format!("{filter:?} {channel}");
            assert_near(&name, mean(&picture, channel), wanted);
        }
    }
}

/// Helmholtz: light and eye change places, and as much light comes, of all bounces, between Lambert's surfaces and in matter
/// that scatters to all sides alike.
#[test]
fn light_and_eye_may_change_places_among_surfaces() {
    let volume = blobs();
    let function = matter([0.9; 3], &[(0.0, 0.0), (0.4, 0.1), (1.0, 0.1)]);
    let ways = [dvec3(1.0, 0.3, 0.5), dvec3(-0.3, 0.9, 0.6)].map(DVec3::normalize);
    let seen = |[to_eye, to_light]: [DVec3; 2], seed| {
        let target = dvec3(20.0, 14.4, 18.2);
        let camera = Camera {
            eye: target + 60.0 * to_eye,
            target,
            up: DVec3::Z,
            projection: Projection::Orthographic { view_height: 64.0 },
            zoom: 1.0,
        };
        let path = PathTracing {
            samples: 16,
            lights: vec![light(to_light)],
            seed,
            ..PathTracing::default()
        };
        let settings = with_levels(path, &[(0.3, [0.8; 3], 0.8)]);
        let scene = scene(&volume, &function, &camera, &settings, [64; 2]);
        mean_of(&drawn(&scene), 0)
    };
    let [[a, of_a], [b, of_b]] = [seen(ways, 0), seen([ways[1], ways[0]], 1)];
    let error = of_a.hypot(of_b);
    println!("{a} {b} +- {error}");
    assert!((a - b).abs() < 4.0 * error, "{a} {b} +- {error}");
    assert!(error < 0.02 * a, "{error} of {a}");
}
