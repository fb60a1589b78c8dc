//! Labels over pictures that do not mix them: of each ray the first whose opacity is not 0.

use super::*;
use glam::dvec3;
use stratavox::camera::{Camera, Projection};
use stratavox::technique::{ClipPlane, Settings};
use stratavox::volume::labels::hide;

const DIMS: [u32; 3] = [6, 5, 4];
/// Pixels along a voxel.
const PIXELS: u32 = 4;
/// By label: none of 0; opacities that differ, and one that is not seen.
const OPACITIES: [f64; 4] = [0.0, 0.25, 0.7, 0.0];
const COLORS: [[f64; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.2], [0.1, 0.8, 0.3], [1.0; 3]];

fn label([x, y, z]: [u32; 3]) -> usize {
    ((x + 2 * y + 3 * z) % 4) as usize
}

fn map() -> Volume {
    let [nx, ny, nz] = DIMS;
    let all = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
    let voxels = Voxels::U8(all.map(|voxel| label(voxel) as u8).collect());
    Volume::from_voxels(DIMS, DAffine3::IDENTITY, voxels, Rescale::default(), None).unwrap()
}

fn names() -> TransferFunction {
    let mut names = label_colors();
    for (i, (color, point)) in names.color.iter_mut().zip(&mut names.opacity).enumerate() {
        (color.srgb, point.opacity) = (COLORS[i], OPACITIES[i]);
    }
    names
}

/// Half grey everywhere, so that a projection is half grey too.
fn grey() -> (Volume, TransferFunction) {
    let mut function = fog([0.5; 3], 1.0);
    function.opacity[0].opacity = 1.0;
    (volume_of(DIMS, DAffine3::IDENTITY, |_| 1.0), function)
}

/// From behind the last slice on, along -z, pixel by pixel of a quarter of a voxel.
fn camera() -> Camera {
    let middle = dvec3(3.0, 2.5, 2.0);
    Camera {
        eye: middle + 9.0 * DVec3::Z,
        target: middle,
        up: DVec3::Y,
        projection: Projection::Orthographic { view_height: 5.0 },
        zoom: 1.0,
    }
}

fn settings(mode: Mode) -> Settings {
    Settings {
        mode,
        color_space: ColorSpace::Display,
        ..Settings::default()
    }
}

/// Asserts that each pixel shows the label that `wanted` says of its column, over the grey.
fn assert_labels(settings: &Settings, map: &Volume, wanted: impl Fn([u32; 2]) -> usize) {
    let (volume, function) = grey();
    let names = names();
    let channels = [channel(map, &names, Role::Labels)];
    let camera = camera();
    let scene = Scene {
        volume: &volume,
        transfer: Some(&function),
        beside: Beside::Channels(&channels),
        camera: &camera,
        extent_pixels: [DIMS[0] * PIXELS, DIMS[1] * PIXELS],
        settings,
    };
    let mut renderer = renderer(&[&volume, map]);
    for (way, picture) in ["f64", "f32", "device"]
        .into_iter()
        .zip(pictures(&mut renderer, &scene))
    {
        for (i, found) in (0..).zip(&picture.pixels) {
            let [x, y] = [
                i % picture.width / PIXELS,
                DIMS[1] - 1 - i / picture.width / PIXELS,
            ];
            let label = wanted([x, y]);
            let a = OPACITIES[label];
            for (c, own) in COLORS[label].into_iter().enumerate() {
                // An 8-bit texture of labels, a table in f32, two products: rounding alone.
                let off = f64::from(found[c]) - (a * own + (1.0 - a) * 0.5);
                assert!(
                    off.abs() < 1e-5,
                    "{way}, voxel {x} {y}, channel {c}: {off:e}"
                );
            }
            assert!((found[3] - 1.0).abs() < 1e-5, "{way}, voxel {x} {y}");
        }
    }
}

#[test]
fn a_thin_cut_has_the_labels_of_its_plane() {
    for z in 0..DIMS[2] {
        let middle = f64::from(z) + 0.4;
        let mut settings = settings(Mode::Average);
        settings.clip_planes = [1.0, -1.0]
            .map(|side| ClipPlane {
                normal: side * DVec3::Z,
                offset: side * middle - 0.005,
            })
            .to_vec();
        assert_labels(&settings, &map(), |[x, y]| label([x, y, z]));
    }
}

#[test]
fn a_projection_has_the_first_label_along_each_ray() {
    for mode in [Mode::Mip, Mode::Minip, Mode::Average, Mode::Lmip] {
        let mut settings = settings(mode);
        settings.per_mode.lmip_threshold = 0.5;
        assert_labels(&settings, &map(), |[x, y]| {
            let along = (0..DIMS[2]).rev().map(|z| label([x, y, z]));
            along.into_iter().find(|&l| OPACITIES[l] > 0.0).unwrap_or(0)
        });
    }
}

#[test]
fn hidden_labels_do_not_lie_over_it() {
    let mut map = map();
    hide(&mut map, |label| label != 1);
    assert_labels(&settings(Mode::Mip), &map, |[x, y]| {
        let is_there = (0..DIMS[2]).any(|z| label([x, y, z]) == 2);
        if is_there { 2 } else { 0 }
    });
}

#[test]
fn labels_over_two_channels_are_drawn_as_the_reference_draws_them() {
    let first = with_holes(volume_of(GRID().dims, sheared_affine(), waves), 7);
    let (second, labels) = (ripples(), blocks());
    let functions = [tinted([0.0, 0.9, 1.0]), tinted([1.0, 0.2, 0.9])];
    let names = label_colors();
    let channels = [
        channel(&second, &functions[1], Role::Numbers),
        channel(&labels, &names, Role::Labels),
    ];
    for mode in [Mode::Mip, Mode::Average] {
        let beside = Beside::Channels(&channels);
        check_against_references(&first, &functions[0], beside, mode, "labels over");
    }
}

#[test]
fn a_map_on_another_grid_and_one_before_numbers_are_refused() {
    let (volume, function) = grey();
    let (map, names) = (map(), names());
    let coarse = volume_of([3, 5, 4], DAffine3::IDENTITY, |_| 1.0);
    let numbers = channel(&volume, &function, Role::Numbers);
    let settings = settings(Mode::Mip);
    let camera = camera();
    let of = |channels: &[Channel]| {
        let beside = Beside::Channels(channels);
        let scene = Scene {
            volume: &volume,
            transfer: Some(&function),
            beside,
            camera: &camera,
            extent_pixels: [8; 2],
            settings: &settings,
        };
        scene.check()
    };
    let labels = channel(&map, &names, Role::Labels);
    assert!(of(&[numbers, labels]).is_ok());
    assert!(matches!(
        of(&[labels, numbers]),
        Err(Error::NotMixed { .. })
    ));
    let elsewhere = channel(&coarse, &names, Role::Labels);
    assert!(matches!(of(&[elsewhere]), Err(Error::OtherGrid)));
}
