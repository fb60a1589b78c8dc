//! What slicers leave out changes no bit of a picture.

use crate::shared::{device, device_with, oblique_camera, projections, volume_of};
use crate::skipping_shared::{Numbers, balls, cameras, hills, samples_of_same_pictures};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::gpu::Caps;
use stratavox::offscreen::Renderer;
use stratavox::scene::Scene;
use stratavox::technique::{ClipPlane, Filter, Order, Settings, Shading, Technique};
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use stratavox::volume::Volume;

/// Every word that has a say in where slices have samples.
fn settings(numbers: &mut Numbers, volume: &Volume) -> Settings {
    let grid = volume.grid();
    let filters = [
        Filter::Linear,
        Filter::Linear,
        Filter::Nearest,
        Filter::Cubic,
        Filter::CatmullRom,
    ];
    let technique = [Technique::Slices3d, Technique::Slices2d][numbers.below(2)];
    let is_stack = technique == Technique::Slices2d;
    let mut settings = Settings {
        technique,
        order: [Order::BackToFront, Order::FrontToBack][numbers.below(2)],
        samples_per_voxel: [0.6, 1.0, 2.3][numbers.below(3)],
        rays_per_side: [1, 1, 2][numbers.below(3)],
        conformance: numbers.below(3) == 0,
        ..Settings::default()
    };
    settings.uneven_rays = settings.rays_per_side > 1;
    match numbers.below(4) {
        0 => settings.preintegrated = true,
        1 if is_stack => settings.smooth = true,
        2 => settings.shading = Some(Shading::default()),
        _ => settings.filter = filters[numbers.below(filters.len())],
    }
    if is_stack && numbers.below(3) == 0 {
        settings.stack = Some(numbers.below(3));
    }
    if numbers.below(2) == 0 {
        settings.crop = Some([dvec3(3.5, 2.0, 6.25), dvec3(37.0, 28.5, 22.0)]);
        settings.clip_planes = vec![ClipPlane {
            normal: dvec3(0.3, -0.2, 0.9),
            offset: dvec3(0.3, -0.2, 0.9).dot(grid.center()) - 4.0,
        }];
    }
    settings
}

/// Those of ray casters, along an axis, and near.
fn all_cameras(volume: &Volume) -> Vec<Camera> {
    let grid = volume.grid();
    let mut all = cameras(&grid);
    let first = all[0];
    all.push(Camera {
        eye: grid.center() + 90.0 * grid.world_from_voxel.matrix3.z_axis.normalize(),
        target: grid.center(),
        up: dvec3(0.1, 1.0, 0.0),
        ..first
    });
    let near = grid
        .world_from_voxel
        .transform_point3(dvec3(20.0, 15.0, -1.5));
    all.push(Camera {
        eye: near,
        target: grid.center(),
        projection: Projection::Perspective { fov_degrees: 110.0 },
        ..first
    });
    all
}

fn compare_many(caps: impl Fn() -> Caps, seed: u64, pictures: usize, most: f64) {
    let mut numbers = Numbers(seed);
    let mut sums = [0.0; 2];
    for as_bytes in [true, false] {
        let volume = balls(&mut numbers, as_bytes);
        let cameras = all_cameras(&volume);
        let mut renderer = Renderer::new(device_with(caps()), &volume).expect("a renderer");
        for _ in 0..pictures {
            let function = hills(&mut numbers, volume.value_range);
            let settings = settings(&mut numbers, &volume);
            let scene = Scene {
                volume: &volume,
                transfer: Some(&function),
                beside: Default::default(),
                camera: &cameras[numbers.below(cameras.len())],
                extent_pixels: [[61, 44], [9, 5], [33, 64]][numbers.below(3)],
                settings: &settings,
            };
            let found = samples_of_same_pictures(&mut renderer, &scene);
            assert!(found[0] <= found[1], "{found:?} samples");
            sums = [sums[0] + found[0], sums[1] + found[1]];
        }
    }
    assert!(
        sums[0] < most * sums[1],
        "hardly anything was left out: {sums:?}"
    );
}

#[test]
fn pictures_are_the_same_to_the_bit_whatever_slices_leave_out() {
    compare_many(|| Caps::UNLIMITED, 11, 8, 0.8);
}

#[test]
fn and_so_they_are_in_bricks() {
    let small = || Caps {
        max_image_dimension_3d: 19,
        max_image_array_layers: 17,
        ..Caps::UNLIMITED
    };
    compare_many(small, 5, 4, 0.95);
}

#[test]
fn and_so_they_are_where_halves_are_blended() {
    let halves = || Caps {
        float32_blend: false,
        ..Caps::UNLIMITED
    };
    compare_many(halves, 3, 4, 1.0);
}

fn white(points: &[(f64, f64)]) -> TransferFunction {
    let point = |&(value, opacity): &(f64, f64)| OpacityPoint { value, opacity };
    TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: [1.0; 3],
        }],
        opacity: points.iter().map(point).collect(),
        reference_length: None,
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

const TECHNIQUES: [Technique; 2] = [Technique::Slices3d, Technique::Slices2d];

#[test]
fn of_a_ball_in_empty_space_few_samples_are_drawn() {
    let ball = |p: DVec3| 100.0 * f64::from((p - 32.0).length() < 6.0);
    let volume = volume_of([64; 3], DAffine3::IDENTITY, ball);
    let function = white(&[(0.0, 0.0), (20.0, 0.0), (100.0, 0.5)]);
    let camera = oblique_camera(&volume.grid(), projections(&volume.grid())[0]);
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    for technique in TECHNIQUES {
        let settings = Settings {
            technique,
            ..Settings::default()
        };
        let scene = Scene {
            volume: &volume,
            transfer: Some(&function),
            beside: Default::default(),
            camera: &camera,
            extent_pixels: [64; 2],
            settings: &settings,
        };
        let [drawn, whole] = samples_of_same_pictures(&mut renderer, &scene);
        // 24 of 64 voxels along each axis are cells with matter; patches add 16 on each.
        let most = (24.0 + 16.0f64).powi(3) / 64f64.powi(3);
        assert!(drawn < most * whole, "{technique:?}: {drawn} of {whole}");
        assert!(drawn > 0.0);
        // No function at all shows nothing: no sample is taken, and the picture is empty.
        let nothing = white(&[]);
        let scene = Scene {
            transfer: Some(&nothing),
            ..scene
        };
        let [drawn, _] = samples_of_same_pictures(&mut renderer, &scene);
        assert_eq!(drawn, 0.0, "{technique:?}");
    }
}

#[test]
fn behind_what_is_opaque_no_slice_is_drawn_from_front_to_back() {
    // Fog all over, opaque beyond a wall.
    let wall = |p: DVec3| if p.z > 20.0 { 100.0 } else { 10.0 };
    let volume = volume_of([64, 64, 200], DAffine3::IDENTITY, wall);
    let function = white(&[(0.0, 0.001), (50.0, 0.001), (100.0, 1.0)]);
    let grid = volume.grid();
    let camera = Camera {
        eye: grid.center() - dvec3(0.0, 0.0, 300.0),
        target: grid.center(),
        up: dvec3(0.0, 1.0, 0.0),
        projection: Projection::Orthographic { view_height: 60.0 },
        zoom: 1.0,
    };
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    for technique in TECHNIQUES {
        for order in [Order::FrontToBack, Order::BackToFront] {
            let settings = Settings {
                technique,
                order,
                ..Settings::default()
            };
            let scene = Scene {
                volume: &volume,
                transfer: Some(&function),
                beside: Default::default(),
                camera: &camera,
                extent_pixels: [64; 2],
                settings: &settings,
            };
            let [drawn, whole] = samples_of_same_pictures(&mut renderer, &scene);
            let share = drawn / whole;
            match order {
                // One batch of 64 slices of 200.
                Order::FrontToBack => assert!(share < 0.35, "{technique:?}: {drawn} of {whole}"),
                Order::BackToFront => assert_eq!(share, 1.0, "{technique:?}"),
            }
        }
    }
}

#[test]
fn what_is_nearly_opaque_goes_on() {
    let volume = volume_of([24, 24, 200], DAffine3::IDENTITY, |p| p.z);
    // After 64 slices 0.99 is opaque, and what comes is of another colour.
    let color = |(value, srgb)| ColorPoint { value, srgb };
    let function = TransferFunction {
        color: [(0.0, [0.1, 0.0, 0.2]), (200.0, [1.0, 0.9, 0.1])]
            .map(color)
            .into(),
        ..white(&[(0.0, 0.08)])
    };
    let grid = volume.grid();
    let camera = Camera {
        eye: grid.center() - dvec3(0.0, 0.0, 300.0),
        target: grid.center(),
        up: dvec3(0.0, 1.0, 0.0),
        projection: Projection::Orthographic { view_height: 22.0 },
        zoom: 1.0,
    };
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    for technique in TECHNIQUES {
        let settings = Settings {
            technique,
            order: Order::FrontToBack,
            ..Settings::default()
        };
        let scene = Scene {
            volume: &volume,
            transfer: Some(&function),
            beside: Default::default(),
            camera: &camera,
            extent_pixels: [32; 2],
            settings: &settings,
        };
        let [drawn, whole] = samples_of_same_pictures(&mut renderer, &scene);
        assert_eq!(drawn, whole, "{technique:?}");
    }
}

#[test]
fn a_voxel_at_the_border_of_a_cell_is_drawn_from_the_cells_beside() {
    let bright = [
        [7, 12, 12],
        [12, 8, 12],
        [12, 12, 15],
        [16, 4, 4],
        [6, 17, 19],
        [17, 20, 9],
        [3, 3, 17],
        [20, 6, 20],
        [4, 14, 4],
    ];
    let at = |p: DVec3| [p.x as u32, p.y as u32, p.z as u32];
    let field = |p: DVec3| 100.0 * f64::from(bright.contains(&at(p)));
    let volume = volume_of([24; 3], DAffine3::IDENTITY, field);
    let function = white(&[(0.1, 0.0), (0.2, 0.5), (100.0, 0.9)]);
    let camera = oblique_camera(&volume.grid(), projections(&volume.grid())[0]);
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    for technique in TECHNIQUES {
        for (filter, preintegrated) in [
            (Filter::Linear, false),
            (Filter::CubicSmooth, false),
            (Filter::Linear, true),
        ] {
            let settings = Settings {
                technique,
                filter,
                preintegrated,
                samples_per_voxel: if preintegrated { 0.4 } else { 3.0 },
                ..Settings::default()
            };
            let scene = Scene {
                volume: &volume,
                transfer: Some(&function),
                beside: Default::default(),
                camera: &camera,
                extent_pixels: [64; 2],
                settings: &settings,
            };
            let [drawn, whole] = samples_of_same_pictures(&mut renderer, &scene);
            assert!(drawn <= whole, "{settings:?}: {drawn} of {whole}");
        }
    }
}
