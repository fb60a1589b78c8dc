//! A device that does not blend 32-bit floats slices in merged batches of 16-bit floats, or says what it lacks.

use crate::shared::{
    Comparison, device, device_with, oblique_camera, projections, ramps, sheared_affine, volume_of,
    waves,
};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::gpu::{self, Caps};
use stratavox::offscreen::{Error, Renderer};
use stratavox::picture::LayerKind;
use stratavox::scene::Scene;
use stratavox::technique::{Filter, Mode, Order, Settings, Technique};
use stratavox::volume::Volume;

fn without_float_blend() -> Caps {
    Caps {
        float32_blend: false,
        ..Caps::UNLIMITED
    }
}

const SLICERS: [Technique; 2] = [Technique::Slices3d, Technique::Slices2d];

/// Three sheets of one slice each, far apart in 1300 slices, so that each lies in a batch of its own; all else is
/// transparent and changes no target.
fn sheets() -> Volume {
    volume_of([6, 5, 1300], DAffine3::IDENTITY, |p| match p.z as u32 {
        40 => 0.55,
        700 => 0.75,
        1260 => 0.95,
        _ => 0.0,
    })
}

/// Each of three blends rounds a number below 1 to 11 bits, upwards or downwards as the driver likes.
const HALF_TOLERANCE: f32 = 3.0 / 2048.0;

#[test]
fn batches_of_16_bit_floats_make_the_picture_of_32_bit_ones() {
    let volume = sheets();
    let transfer = ramps();
    let grid = volume.grid();
    let camera = Camera {
        eye: grid.center() - dvec3(0.0, 0.0, 1000.0),
        target: grid.center(),
        up: DVec3::Y,
        projection: Projection::Orthographic { view_height: 4.0 },
        zoom: 1.0,
    };
    let mut wanted = Renderer::new(device(), &volume).unwrap();
    let mut found = Renderer::new(device_with(without_float_blend()), &volume).unwrap();
    for technique in SLICERS {
        for order in [Order::BackToFront, Order::FrontToBack] {
            let settings = Settings {
                technique,
                order,
                filter: Filter::Nearest,
                // All slices, so that there are three batches.
                skip: false,
                ..Settings::default()
            };
            let scene = Scene {
                beside: Default::default(),
                volume: &volume,
                transfer: Some(&transfer),
                camera: &camera,
                extent_pixels: [16, 12],
                settings: &settings,
            };
            let layers = [LayerKind::Samples];
            let wanted = wanted.render(&scene, &layers).unwrap().picture;
            let found = found.render(&scene, &layers).unwrap().picture;
            assert_eq!(
                wanted.layers, found.layers,
                "{technique:?} {order:?}: samples"
            );
            assert_eq!(
                wanted.layers[0].values[100], 1300.0,
                "{technique:?}: three batches"
            );
            assert!(
                wanted.pixels[100][3] > 0.5,
                "{technique:?}: the sheets are seen"
            );
            let comparison =
                Comparison::of(wanted.pixels.as_flattened(), found.pixels.as_flattened());
            assert!(
                comparison.worst() > 0.0,
                "{technique:?}: the targets were not of 16 bits"
            );
            comparison.at_most(HALF_TOLERANCE, &format!("{technique:?} {order:?}"));
        }
    }
}

#[test]
fn projections_by_blending_are_refused_by_name() {
    let volume = volume_of([5, 6, 7], sheared_affine(), waves);
    let mut renderer = Renderer::new(device_with(without_float_blend()), &volume).unwrap();
    for technique in SLICERS {
        for mode in [Mode::Mip, Mode::Minip, Mode::Average, Mode::Xray] {
            let settings = Settings {
                technique,
                mode,
                ..Settings::default()
            };
            let grid = volume.grid();
            let camera = oblique_camera(&grid, projections(&grid)[0]);
            let scene = Scene {
                beside: Default::default(),
                volume: &volume,
                transfer: None,
                camera: &camera,
                extent_pixels: [8, 8],
                settings: &settings,
            };
            let refused = renderer.render(&scene, &[]).unwrap_err();
            assert!(
                matches!(
                    refused,
                    Error::Gpu(gpu::Error::Format {
                        lacks: "blending",
                        ..
                    })
                ),
                "{technique:?} {mode:?}: {refused}"
            );
            assert!(
                refused.to_string().contains("R32G32B32A32_SFLOAT"),
                "{refused}"
            );
        }
    }
}

#[test]
fn rays_do_not_need_blending() {
    let volume = volume_of([5, 6, 7], sheared_affine(), waves);
    let transfer = ramps();
    let settings = Settings {
        rays_per_side: 2,
        ..Settings::default()
    };
    let grid = volume.grid();
    let camera = oblique_camera(&grid, projections(&grid)[0]);
    let scene = Scene {
        beside: Default::default(),
        volume: &volume,
        transfer: Some(&transfer),
        camera: &camera,
        extent_pixels: [24, 20],
        settings: &settings,
    };
    let picture = |caps| {
        let mut renderer = Renderer::new(device_with(caps), &volume).unwrap();
        renderer.render(&scene, &[]).unwrap().picture
    };
    assert_eq!(picture(without_float_blend()), picture(Caps::UNLIMITED));
}
