//! Slabs, planes between slices, and jitter: each shader computes what its CPU reference computes, in bricks too, and what
//! has no such way to sample refuses by name.

use crate::shared::{
    PictureCase, compare, device, device_with, oblique_camera, projections, ramps, sheared_affine,
    volume_of, waves,
};
use glam::dvec3;
use stratavox::camera::{Camera, Projection};
use stratavox::gpu::Caps;
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::LayerKind;
use stratavox::technique::{Error, Filter, Jitter, Lattice, Mode, Order, Settings, Technique};
use stratavox::transfer::{Interpolation, TransferFunction};
use stratavox::volume::Volume;

pub(super) const DIMS: [u32; 3] = [11, 13, 9];

/// Every way to sample that this file is about.
pub(super) fn ways() -> Vec<Settings> {
    let way = |technique, lattice, preintegrated, smooth| Settings {
        technique,
        lattice,
        preintegrated,
        smooth,
        jitter: Jitter { seed: 3, frame: 5 },
        conformance: true,
        ..Settings::default()
    };
    use {
        Lattice::{Planes, Ray},
        Technique::*,
    };
    let front_to_back = |settings| Settings {
        order: Order::FrontToBack,
        ..settings
    };
    vec![
        way(Raycast, Ray, true, false),
        way(Raycast, Planes, true, false),
        way(Raycast, Lattice::Jitter, true, false),
        way(Raycast, Lattice::Jitter, false, false),
        way(Slices3d, Ray, true, false),
        front_to_back(way(Slices3d, Ray, true, false)),
        way(Slices2d, Ray, true, false),
        front_to_back(way(Slices2d, Ray, true, true)),
        way(Slices2d, Ray, false, true),
        front_to_back(way(Slices2d, Ray, false, true)),
    ]
}

pub(super) fn shot(camera: Camera, settings: Settings, volume: &Volume) -> PictureCase {
    PictureCase {
        grid: volume.grid(),
        camera,
        extent: [24, 20],
        settings,
    }
}

fn what(settings: &Settings) -> String {
    let Settings {
        technique,
        lattice,
        order,
        filter,
        preintegrated,
        smooth,
        ..
    } = settings;
    format!("{technique:?} {lattice:?} {order:?} {filter:?} slabs {preintegrated} smooth {smooth}")
}

pub(super) fn check(
    renderer: &mut Renderer,
    volume: &Volume,
    transfer: &TransferFunction,
    shot: &PictureCase,
) {
    let scene = shot.scene(volume, Some(transfer));
    let kinds = [LayerKind::Samples];
    let found = renderer.render(&scene, &kinds).unwrap().picture;
    let double = reference::render::<f64>(&scene).unwrap();
    let single = reference::render::<f32>(&scene).unwrap();
    let what = format!("{} {:?}", what(&shot.settings), shot.camera.projection);
    let all = [&double, &single, &found];
    compare(
        &what,
        4 * found.width,
        all.map(|p| p.pixels.as_flattened()),
        1.0,
    );
    let drawn = single.pixels.iter().filter(|p| p[3] > 0.01).count();
    assert!(drawn > 50, "{what}: only {drawn} pixels are drawn");
    let samples = |picture: &'_ stratavox::picture::Picture| {
        let layer = picture.layers.iter().find(|l| l.kind == kinds[0]);
        layer.unwrap().values.clone()
    };
    let counts = all.map(samples);
    let most = counts[0].iter().copied().fold(1.0, f32::max);
    compare(
        &format!("samples of {what}"),
        found.width,
        [&counts[0], &counts[1], &counts[2]],
        most,
    );
}

#[test]
fn every_way_to_sample_draws_what_its_reference_computes() {
    let volume = volume_of(DIMS, sheared_affine(), waves);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let steps = TransferFunction {
        interpolation: Interpolation::Step,
        ..ramps()
    };
    let cameras = projections(&volume.grid()).map(|p| oblique_camera(&volume.grid(), p));
    // Pictures of one pipeline one after the other: making it is what takes time.
    for settings in ways() {
        let nearest = Settings {
            filter: Filter::Nearest,
            ..settings.clone()
        };
        let cut = Settings {
            samples_per_voxel: 0.6,
            crop: Some([dvec3(1.3, 0.7, -4.0), dvec3(10.2, 99.0, 8.3)]),
            ..settings.clone()
        };
        for (camera, transfer, settings) in [
            (cameras[0], ramps(), settings.clone()),
            (cameras[1], ramps(), settings),
            (cameras[1], steps.clone(), cut),
            (cameras[0], ramps(), nearest),
        ] {
            let shot = shot(camera, settings, &volume);
            check(&mut renderer, &volume, &transfer, &shot);
        }
    }
}

#[test]
fn the_eye_inside_sees_slabs_all_around() {
    let volume = volume_of(DIMS, sheared_affine(), waves);
    let grid = volume.grid();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    // Everything seen must be covered: fog that thickens nowhere.
    let fog = TransferFunction {
        opacity: vec![stratavox::transfer::OpacityPoint {
            value: 0.0,
            opacity: 0.1,
        }],
        ..ramps()
    };
    let eyes = [
        (dvec3(4.3, 7.1, 4.2), ramps()),
        (dvec3(5.51, 6.51, 4.51), fog),
    ];
    for settings in ways() {
        for (eye, transfer) in &eyes {
            let camera = Camera {
                eye: grid.world_from_voxel.transform_point3(*eye),
                target: grid
                    .world_from_voxel
                    .transform_point3(dvec3(3.0, 10.0, 2.0)),
                ..oblique_camera(&grid, Projection::Perspective { fov_degrees: 110.0 })
            };
            let shot = shot(camera, settings.clone(), &volume);
            check(&mut renderer, &volume, transfer, &shot);
        }
    }
}

pub(super) fn with_holes() -> Volume {
    let mut volume = volume_of(DIMS, sheared_affine(), waves);
    let mask = (0..11 * 13 * 9)
        .map(|i: u32| u8::from(!i.is_multiple_of(41) && i % 53 != 3))
        .collect();
    volume.validity = Some(mask);
    volume
}

#[test]
fn holes_hide_the_slabs_that_touch_them() {
    let volume = with_holes();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let camera = oblique_camera(&volume.grid(), projections(&volume.grid())[0]);
    for settings in ways() {
        let shot = shot(camera, settings, &volume);
        check(&mut renderer, &volume, &ramps(), &shot);
    }
}

/// Caps under which the volume takes bricks along every axis.
fn small() -> Caps {
    Caps {
        max_image_dimension_3d: 9,
        max_image_array_layers: 6,
        ..Caps::UNLIMITED
    }
}

#[test]
fn bricks_leave_slabs_bit_identical() {
    assert_bricks_leave(ways());
}

/// Pictures of a volume in bricks are those of the whole one to the bit.
pub(super) fn assert_bricks_leave(ways: Vec<Settings>) {
    let volume = with_holes();
    let mut whole = Renderer::new(device(), &volume).unwrap();
    let mut bricked = Renderer::new(device_with(small()), &volume).unwrap();
    let camera = oblique_camera(&volume.grid(), projections(&volume.grid())[1]);
    for settings in ways {
        let settings = Settings {
            termination: 0.01,
            ..settings
        };
        let shot = shot(camera, settings, &volume);
        let transfer = ramps();
        let scene = shot.scene(&volume, Some(&transfer));
        let layers = [LayerKind::Samples];
        let wanted = whole.render(&scene, &layers).unwrap().picture;
        let found = bricked.render(&scene, &layers).unwrap().picture;
        let differ = wanted
            .pixels
            .iter()
            .zip(&found.pixels)
            .filter(|(a, b)| a != b);
        assert_eq!(differ.count(), 0, "{}: pixels", what(&shot.settings));
        assert_eq!(
            wanted.layers,
            found.layers,
            "{}: samples",
            what(&shot.settings)
        );
    }
}

#[test]
fn slabs_that_reach_out_of_bricks_are_refused() {
    let volume = with_holes();
    let mut bricked = Renderer::new(device_with(small()), &volume).unwrap();
    let camera = oblique_camera(&volume.grid(), projections(&volume.grid())[1]);
    let settings = Settings {
        samples_per_voxel: 0.1,
        ..ways().swap_remove(0)
    };
    let shot = shot(camera, settings, &volume);
    let transfer = ramps();
    let error = bricked
        .render(&shot.scene(&volume, Some(&transfer)), &[])
        .unwrap_err();
    assert!(
        error.to_string().contains("more samples per voxel"),
        "{error}"
    );
}

#[test]
fn what_has_no_such_way_to_sample_is_refused_by_name() {
    let settings = |technique, mode, lattice| Settings {
        technique,
        mode,
        lattice,
        ..Settings::default()
    };
    use Technique::*;
    let slabs = Settings {
        preintegrated: true,
        ..settings(Raycast, Mode::Mip, Lattice::Ray)
    };
    let smooth = |technique, mode| Settings {
        smooth: true,
        ..settings(technique, mode, Lattice::Ray)
    };
    for (settings, wanted, found) in [
        (slabs, "pre-integrated", "mode mip"),
        (
            smooth(Raycast, Mode::Composite),
            "between slices",
            "raycast",
        ),
        (
            smooth(Slices2d, Mode::Average),
            "between slices",
            "mode average",
        ),
        (
            settings(Slices3d, Mode::Composite, Lattice::Jitter),
            "jitter",
            "slices-3d",
        ),
        (
            settings(Raycast, Mode::Iso, Lattice::Jitter),
            "jitter",
            "surfaces",
        ),
    ] {
        let error = settings.check().unwrap_err();
        assert!(matches!(error, Error::NotFor { .. }), "{error}");
        let text = error.to_string();
        assert!(text.contains(wanted) && text.contains(found), "{text}");
    }
}
