//! A volume in many bricks is the same picture as in one.

mod shared;

use shared::{
    device, device_with, oblique_camera, projections, ramps, sheared_affine, volume_of, waves,
};
use stratavox::camera::{Camera, Projection};
use stratavox::gpu::Caps;
use stratavox::offscreen::Renderer;
use stratavox::picture::LayerKind;
use stratavox::scene::Scene;
use stratavox::technique::{Filter, Lattice, Mode, Order, Settings, Shading, Technique};
use stratavox::volume::Volume;

/// Caps under which a volume of 17 x 21 x 13 voxels takes bricks along every axis.
fn small() -> Caps {
    Caps {
        max_image_dimension_3d: 11,
        max_image_array_layers: 8,
        ..Caps::UNLIMITED
    }
}

/// Each technique with each way to gather; every word of the settings that bricks could disturb is there.
fn settings() -> Vec<Settings> {
    let gathers = [
        (
            Mode::Composite,
            Lattice::Ray,
            Order::BackToFront,
            Filter::Linear,
        ),
        (
            Mode::Composite,
            Lattice::Planes,
            Order::FrontToBack,
            Filter::Nearest,
        ),
        (Mode::Mip, Lattice::Ray, Order::BackToFront, Filter::Linear),
        (
            Mode::Average,
            Lattice::Planes,
            Order::FrontToBack,
            Filter::Linear,
        ),
        (
            Mode::Composite,
            Lattice::Planes,
            Order::FrontToBack,
            Filter::Cubic,
        ),
        (
            Mode::Mip,
            Lattice::Ray,
            Order::BackToFront,
            Filter::CatmullRom,
        ),
    ];
    let techniques = [Technique::Raycast, Technique::Slices3d, Technique::Slices2d];
    let of_technique = |technique| {
        gathers.map(|(mode, lattice, order, filter)| Settings {
            technique,
            mode,
            lattice,
            order,
            filter,
            termination: if mode == Mode::Composite { 0.01 } else { 0.0 },
            conformance: true,
            ..Settings::default()
        })
    };
    let dark: Vec<Settings> = techniques.into_iter().flat_map(of_technique).collect();
    // Gradients reach one voxel further.
    let is_lit = |settings: &&Settings| settings.mode == Mode::Composite;
    let lit = dark.iter().filter(is_lit).map(|settings| Settings {
        shading: Some(Shading::default()),
        ..settings.clone()
    });
    dark.iter().cloned().chain(lit).collect()
}

fn assert_same_picture(volume: &Volume, camera: &Camera) {
    let transfer = ramps();
    let mut whole = Renderer::new(device(), volume).unwrap();
    let mut bricked = Renderer::new(device_with(small()), volume).unwrap();
    for settings in settings() {
        let scene = Scene {
            beside: Default::default(),
            volume,
            transfer: Some(&transfer),
            camera,
            extent_pixels: [40, 32],
            settings: &settings,
        };
        let layers = [LayerKind::Samples];
        let wanted = whole.render(&scene, &layers).unwrap().picture;
        let found = bricked.render(&scene, &layers).unwrap().picture;
        let drawn = wanted.pixels.iter().filter(|p| p[3] > 0.0).count();
        assert!(drawn > 100, "{settings:?}: only {drawn} pixels are drawn");
        let differ = wanted
            .pixels
            .iter()
            .zip(&found.pixels)
            .filter(|(a, b)| a != b)
            .count();
        assert_eq!(differ, 0, "{settings:?}: pixels that differ, of {drawn}");
        assert_eq!(wanted.layers, found.layers, "{settings:?}: samples");
    }
}

#[test]
fn bricks_leave_a_picture_bit_identical() {
    let volume = volume_of([17, 21, 13], sheared_affine(), waves);
    for projection in projections(&volume.grid()) {
        assert_same_picture(&volume, &oblique_camera(&volume.grid(), projection));
    }
}

#[test]
fn bricks_leave_a_picture_bit_identical_from_inside() {
    let volume = volume_of([17, 21, 13], sheared_affine(), waves);
    let grid = volume.grid();
    let camera = Camera {
        eye: grid
            .world_from_voxel
            .transform_point3(glam::dvec3(8.3, 11.2, 6.1)),
        target: grid
            .world_from_voxel
            .transform_point3(glam::dvec3(1.0, 20.0, 12.0)),
        up: glam::DVec3::Z,
        projection: Projection::Perspective { fov_degrees: 100.0 },
        zoom: 1.0,
    };
    assert_same_picture(&volume, &camera);
}

#[test]
fn bricks_leave_holes_where_they_are() {
    let mut volume = volume_of([17, 21, 13], sheared_affine(), waves);
    // Few: a cubic sample has no data where one of 64 voxels has none.
    let mask = (0..17 * 21 * 13)
        .map(|i: u32| u8::from(!i.is_multiple_of(101) && i % 211 != 3))
        .collect();
    volume.validity = Some(mask);
    let camera = oblique_camera(&volume.grid(), projections(&volume.grid())[1]);
    assert_same_picture(&volume, &camera);
}
