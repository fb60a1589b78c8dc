//! The shader against its CPU references, and what changes no bit.

use crate::pathtrace::{around_blobs, light, matter, scene};
use crate::shared::{
    PictureCase, compare, device, device_with, oblique_shots, ramps, sheared_affine, volume_of,
    waves,
};
use glam::{DAffine3, dvec3};
use stratavox::camera::Camera;
use stratavox::gpu::Caps;
use stratavox::offscreen::{self, Renderer, reference};
use stratavox::picture::ColorSpace;
use stratavox::scene::{Beside, Channel, Scene};
use stratavox::technique::pathtrace::{Lamp, LampShape, PathTracing, Phase, SkyPicture};
use stratavox::technique::{
    AmbientOcclusion, Error, Filter, Lattice, Mode, Role, Settings, Shading, SingleScattering,
    Technique,
};
use stratavox::volume::{Grid, Volume};

const GRID: fn() -> Grid = || Grid {
    dims: [23, 18, 14],
    world_from_voxel: sheared_affine(),
};

/// Rays of both projections, of both lattices.
fn shots() -> Vec<PictureCase> {
    let all = oblique_shots(GRID(), Mode::Composite).into_iter();
    all.filter(|shot| shot.settings.technique == Technique::Raycast)
        .collect()
}

fn lit() -> PathTracing {
    PathTracing {
        albedo: 0.9,
        density: 0.7,
        phase: Phase::TwoLobes {
            part: 0.6,
            g: [0.7, -0.3],
        },
        lights: vec![light(dvec3(1.0, 2.0, 0.5)), light(dvec3(-1.0, 0.2, 1.0))],
        ..PathTracing::default()
    }
}

fn under_a_sky() -> PathTracing {
    PathTracing {
        phase: Phase::Isotropic,
        sky: [0.2, 0.3, 0.5],
        ..lit()
    }
}

/// A driver that counts the turns of loops follows one of them from each sample.
fn by_points(count: usize) -> PathTracing {
    let point = |voxel| Lamp {
        place: GRID().world_from_voxel.transform_point3(voxel),
        shape: LampShape::Sphere { radius: None },
        srgb: [1.0, 0.9, 0.8],
    };
    PathTracing {
        lamps: [dvec3(40.0, -9.0, 3.0), dvec3(11.0, 8.0, 6.0)].map(point)[..count].to_vec(),
        lights: Vec::new(),
        ..lit()
    }
}

fn field(has_holes: bool) -> Volume {
    let mut volume = volume_of(GRID().dims, sheared_affine(), waves);
    if has_holes {
        let count = volume.dims.iter().product::<u32>();
        volume.validity = Some((0..count).map(|i| u8::from(i % 211 != 7)).collect());
    }
    volume
}

#[test]
fn every_way_of_light_is_that_of_its_reference() {
    let ways = [
        (SingleScattering::Open, lit()),
        (SingleScattering::Volume, lit()),
        (SingleScattering::March, lit()),
        (SingleScattering::Volume, under_a_sky()),
        (SingleScattering::March, under_a_sky()),
        (SingleScattering::Open, by_points(2)),
        (SingleScattering::March, by_points(1)),
    ];
    let transfer = ramps();
    for has_holes in [false, true] {
        let volume = field(has_holes);
        let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
        for (nth, (scattering, path)) in ways.iter().enumerate() {
            for (of, shot) in shots().iter().enumerate() {
                // Of holes one shot each.
                if has_holes && of != nth % shots().len() {
                    continue;
                }
                let filters = [Filter::Linear, Filter::Nearest];
                let shot = shot.with(|settings| {
                    settings.single_scattering = Some(*scattering);
                    settings.path = path.clone();
                    settings.filter = filters[(nth + of) % 2];
                    settings.conformance = true;
                });
                let scene = shot.scene(&volume, Some(&transfer));
                let found = renderer.render(&scene, &[]).expect("a picture").picture;
                let double = reference::render::<f64>(&scene).expect("a picture");
                let single = reference::render::<f32>(&scene).expect("a picture");
                let all = [&double, &single, &found].map(|p| p.pixels.as_flattened());
                let what = format!("{scattering:?}, {}", shot.what());
                compare(&what, 4 * found.width, all, 1.0);
                let lit = found.pixels.iter().filter(|pixel| pixel[1] > 0.02);
                assert!(lit.count() > 100, "{what}");
            }
        }
    }
}

fn drawn(renderer: &mut Renderer, scene: &Scene) -> Vec<[f32; 4]> {
    let rendered = renderer.render(scene, &[]);
    rendered.expect("a picture").picture.pixels
}

/// Two balls in a box of 8 x 6 x 5 macro cells, most of them empty.
#[test]
fn what_empty_space_leaves_out_changes_no_bit() {
    let place = DAffine3::from_scale(dvec3(1.0, 0.8, 1.3));
    let volume = volume_of([64, 48, 40], place, |p| {
        let near = p
            .distance(dvec3(14.0, 12.0, 10.0))
            .min(p.distance(dvec3(48.0, 34.0, 28.0)));
        1.0 - near / 12.0
    });
    let transfer = matter([0.9, 0.7, 0.4], &[(0.0, 0.0), (0.5, 0.8), (1.0, 0.3)]);
    let camera = Camera {
        eye: dvec3(110.0, 80.0, 90.0),
        target: dvec3(32.0, 19.0, 26.0),
        ..around_blobs()
    };
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    // The light goes through the other ball, and along an axis.
    for way in [dvec3(-34.0, -17.6, -23.4), dvec3(0.0, 0.0, 1.0)] {
        for scattering in [SingleScattering::Volume, SingleScattering::March] {
            let [with, without] = [true, false].map(|skip| {
                let path = PathTracing {
                    lights: vec![light(way)],
                    ..lit()
                };
                let settings = Settings {
                    single_scattering: Some(scattering),
                    path,
                    skip,
                    ..Settings::default()
                };
                let scene = scene(&volume, &transfer, &camera, &settings, [60, 50]);
                drawn(&mut renderer, &scene)
            });
            assert!(with == without, "{scattering:?}, {way}");
            assert!(with.iter().filter(|pixel| pixel[0] > 0.02).count() > 100);
        }
    }
}

#[test]
fn other_density_lights_and_ways_are_other_pictures_of_one_renderer() {
    let (volume, transfer) = (field(false), ramps());
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    let of = |path: PathTracing, scattering| {
        shots()[0].with(|settings| {
            settings.single_scattering = Some(scattering);
            settings.path = path;
            settings.conformance = true;
        })
    };
    let denser = PathTracing {
        density: 3.0,
        ..lit()
    };
    let other_light = PathTracing {
        lights: vec![light(dvec3(0.0, 0.0, -1.0))],
        ..lit()
    };
    let mut before = Vec::new();
    for (path, scattering) in [
        (lit(), SingleScattering::Volume),
        (denser.clone(), SingleScattering::Volume),
        (denser, SingleScattering::March),
        (other_light.clone(), SingleScattering::March),
        (other_light, SingleScattering::Volume),
        (under_a_sky(), SingleScattering::Volume),
    ] {
        let shot = of(path, scattering);
        let scene = shot.scene(&volume, Some(&transfer));
        let found = drawn(&mut renderer, &scene);
        let fresh = drawn(
            &mut Renderer::new(device(), &volume).expect("a renderer"),
            &scene,
        );
        assert!(found == fresh, "{scattering:?}: something was kept");
        assert!(found != before, "{scattering:?}");
        before = found;
    }
}

fn in_bricks() -> Caps {
    Caps {
        max_image_dimension_3d: 11,
        max_image_array_layers: 8,
        ..Caps::UNLIMITED
    }
}

#[test]
fn light_goes_through_bricks_as_through_one_piece() {
    let (volume, transfer) = (field(false), ramps());
    let mut whole = Renderer::new(device(), &volume).expect("a renderer");
    let mut bricks = Renderer::new(device_with(in_bricks()), &volume).expect("a renderer");
    let shot = shots()[0].with(|settings| {
        settings.single_scattering = Some(SingleScattering::Volume);
        settings.path = under_a_sky();
    });
    let scene = shot.scene(&volume, Some(&transfer));
    let pairs = [&mut whole, &mut bricks].map(|renderer| drawn(renderer, &scene));
    let [wanted, found] = pairs.each_ref().map(|pixels| pixels.as_flattened());
    let apart = wanted.iter().zip(found).map(|(a, b)| (a - b).abs());
    // Only what other bricks leave is added to and rounded.
    let worst = apart.fold(0.0, f32::max);
    assert!(worst < 2e-6, "{worst}");
    let marched = shot.with(|settings| settings.single_scattering = Some(SingleScattering::March));
    let scene = marched.scene(&volume, Some(&transfer));
    let refused = bricks.render(&scene, &[]).expect_err("refused").to_string();
    assert!(refused.contains("bricks"), "{refused}");
    drawn(&mut whole, &scene);
}

type Change<'a> = &'a dyn Fn(&mut Settings);

#[test]
fn what_has_no_light_to_scatter_is_refused_by_name() {
    let (volume, transfer) = (field(false), ramps());
    let refused = |beside: Beside, change: &dyn Fn(&mut Settings)| -> Error {
        let shot = shots()[0].with(|settings| {
            settings.single_scattering = Some(SingleScattering::Volume);
            settings.path = lit();
            change(settings);
        });
        let scene = Scene {
            beside,
            ..shot.scene(&volume, Some(&transfer))
        };
        let error = match reference::render::<f32>(&scene) {
            Err(error) => error,
            Ok(_) => panic!("drawn: {:?}", scene.settings),
        };
        let mut renderer = Renderer::several(device(), scene.volumes()).expect("a renderer");
        match renderer.render(&scene, &[]).expect_err("refused") {
            offscreen::Error::Technique(found) => assert_eq!(found.to_string(), error.to_string()),
            other => panic!("{other}"),
        }
        error
    };
    let changes: [(&str, Change); 19] = [
        ("followed from each sample", &|s| s.path = by_points(2)),
        ("a disc", &|s| {
            s.single_scattering = Some(SingleScattering::Open);
            s.path = by_points(2);
            s.path.lamps[0].shape = LampShape::Disc { radius: 1.0 };
        }),
        ("ray casting", &|s| s.technique = Technique::Slices3d),
        ("composite", &|s| s.mode = Mode::Mip),
        ("composite", &|s| s.mode = Mode::Mida),
        ("filter", &|s| s.filter = Filter::Cubic),
        ("lattice", &|s| s.lattice = Lattice::Bresenham),
        ("points", &|s| s.preintegrated = true),
        ("points", &|s| s.adaptive_steps = Some(0.1)),
        ("shading", &|s| s.shading = Some(Shading::default())),
        ("occlusion", &|s| {
            s.ambient_occlusion = Some(AmbientOcclusion {
                strength: 0.0,
                radius_world: None,
            });
        }),
        ("display", &|s| s.color_space = ColorSpace::Display),
        ("picture of the sky", &|s| {
            let picture = SkyPicture::new([8, 4], &[[1.0; 3]; 32]);
            s.path.sky_picture = Some(picture.expect("a sky"));
        }),
        ("isotropic", &|s| s.path.sky = [1.0; 3]),
        ("look wide", &|s| {
            s.single_scattering = Some(SingleScattering::March);
            s.path.light_size_degrees = 5.0;
        }),
        ("albedos", &|s| s.path.albedo = 1.1),
        ("cosine", &|s| s.path.phase = Phase::HenyeyGreenstein(1.0)),
        ("density", &|s| s.path.density = 0.0),
        ("sky that is seen", &|s| s.path.shows_sky = true),
    ];
    for (wanted, change) in changes {
        let text = refused(Beside::Nothing, change).to_string();
        assert!(text.contains(wanted), "{wanted}: {text}");
    }
    let channels = [Channel {
        volume: &volume,
        transfer: Some(&transfer),
        role: Role::Numbers,
    }];
    let text = refused(Beside::Channels(&channels), &|_| {}).to_string();
    assert!(text.contains("one volume of numbers"), "{text}");
}
