//! Each shader computes what its CPU reference computes: see `shared::compare`.

use crate::shared::{
    PictureCase, Worst, compare, device, oblique_camera, oblique_shots, projections, ramps,
    sheared_affine, volume_of, waves,
};
use glam::{DAffine3, DVec3, Vec3Swizzles, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::{ColorSpace, LayerKind, Picture};
use stratavox::scene::Scene;
use stratavox::technique::{ClipPlane, Filter, Mode, Order, Settings, Technique};
use stratavox::transfer::{Interpolation, TransferFunction};
use stratavox::volume::{Grid, Rescale, Volume, Voxels};

const GRID: fn() -> Grid = || Grid {
    dims: [17, 21, 13],
    world_from_voxel: sheared_affine(),
};
const MODES: [Mode; 5] = [
    Mode::Composite,
    Mode::Mip,
    Mode::Minip,
    Mode::Average,
    Mode::Xray,
];

fn layers_of(shot: &PictureCase) -> Vec<LayerKind> {
    let mode = shot.settings.mode;
    let all = LayerKind::ALL.into_iter();
    all.filter(|kind| match kind {
        LayerKind::Value => mode.is_projection(),
        LayerKind::Depth => shot.settings.technique == Technique::Raycast,
        LayerKind::Transmittance => !mode.is_projection(),
        LayerKind::Position => shot.settings.technique == Technique::Raycast && mode.has_depth(),
        // No shader makes it; tests/exact/normals.rs has exact ones.
        LayerKind::Normal => false,
        // Waves are no labels.
        LayerKind::Label => false,
        // Marks over a picture are the command line's.
        LayerKind::Annotation => false,
        // It is of what is drawn beside the volume: tests/exact/geometry.rs.
        LayerKind::Line => false,
        // Of random paths.
        LayerKind::Noise
        | LayerKind::Albedo
        | LayerKind::Direct
        | LayerKind::Indirect
        | LayerKind::Emission
        | LayerKind::Bounces => false,
        LayerKind::Samples => true,
    })
    .collect()
}

/// Picture and all layers.
fn check(
    renderer: &mut Renderer,
    volume: &Volume,
    transfer: &TransferFunction,
    shot: &PictureCase,
    what: &str,
) {
    let kinds = layers_of(shot);
    // All samples are counted; tests/relations/skipping.rs compares with pictures that leave some out.
    let shot = &shot.with(|s| s.skip = false);
    let scene = shot.scene(volume, Some(transfer));
    let found = renderer.render(&scene, &kinds).unwrap().picture;
    let double = reference::render::<f64>(&scene).unwrap();
    let single = reference::render::<f32>(&scene).unwrap();
    let what = format!("{what}, {}", shot.what());
    let all = [&double, &single, &found];
    // Channel by channel would be four times as long and say no more.
    compare(
        &what,
        4 * found.width,
        all.map(|p| p.pixels.as_flattened()),
        1.0,
    );
    let drawn = single.pixels.iter().filter(|p| p[3] > 0.01).count();
    assert!(drawn > 100, "{what}: only {drawn} pixels are drawn");
    for kind in kinds {
        let values = |picture: &'_ Picture| {
            let layer = picture.layers.iter().find(|layer| layer.kind == kind);
            layer
                .unwrap_or_else(|| panic!("{what}: no layer {kind:?}"))
                .values
                .clone()
        };
        let lists = all.map(values);
        let size = |values: &Vec<f32>| values.iter().copied().fold(1.0, f32::max);
        let scale = size(&lists[0]);
        let lists = [&lists[0][..], &lists[1][..], &lists[2][..]];
        let width = found.width * kind.numbers() as u32;
        compare(&format!("{kind:?} of {what}"), width, lists, scale);
    }
}

#[test]
fn every_technique_mode_and_filter_draws_what_its_reference_computes() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for mode in MODES {
        for shot in oblique_shots(GRID(), mode) {
            for filter in [Filter::Nearest, Filter::Linear] {
                let shot = shot.with(|settings| settings.filter = filter);
                check(
                    &mut renderer,
                    &volume,
                    &transfer,
                    &shot,
                    &format!("{filter:?}"),
                );
            }
        }
    }
}

#[test]
fn the_eye_inside_sees_what_its_reference_computes() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let wide = Projection::Perspective { fov_degrees: 120.0 };
    // In the middle, near a corner, and close to a slice of every stack.
    for eye in [
        dvec3(7.3, 12.1, 6.2),
        dvec3(1.2, 2.7, 11.9),
        dvec3(8.51, 10.51, 6.51),
    ] {
        let camera = Camera {
            eye: GRID().world_from_voxel.transform_point3(eye),
            target: GRID()
                .world_from_voxel
                .transform_point3(dvec3(5.0, 16.0, 3.0)),
            ..oblique_camera(&GRID(), wide)
        };
        for mode in [Mode::Composite, Mode::Xray, Mode::Mip] {
            for shot in oblique_shots(GRID(), mode).into_iter().take(6) {
                let shot = PictureCase { camera, ..shot };
                check(
                    &mut renderer,
                    &volume,
                    &transfer,
                    &shot,
                    &format!("eye at {eye}"),
                );
            }
        }
    }
}

/// The slice has no picture from there, but every ray has its first sample on it, at t = 0. Where the numbers are
/// exact, so is that.
#[test]
fn an_eye_in_a_slices_own_plane_sees_that_slice() {
    let grid = Grid {
        world_from_voxel: DAffine3::IDENTITY,
        ..GRID()
    };
    let volume = volume_of(grid.dims, grid.world_from_voxel, waves);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for target in [
        dvec3(20.0, 12.0, 8.0),
        dvec3(7.0, -4.0, 5.0),
        dvec3(9.0, 12.0, 30.0),
    ] {
        let camera = Camera {
            // The middle of odd numbers of voxels.
            eye: dvec3(8.5, 10.5, 6.5),
            target,
            up: dvec3(0.2, 0.3, 1.0),
            projection: Projection::Perspective { fov_degrees: 100.0 },
            zoom: 1.0,
        };
        for order in [Order::BackToFront, Order::FrontToBack] {
            let settings = Settings {
                technique: Technique::Slices2d,
                order,
                conformance: true,
                ..Settings::default()
            };
            let scene = Scene {
                beside: Default::default(),
                volume: &volume,
                transfer: Some(&transfer),
                camera: &camera,
                extent_pixels: [32, 24],
                settings: &settings,
            };
            let layers = [LayerKind::Samples];
            let found = renderer.render(&scene, &layers).unwrap().picture;
            let wanted = reference::render::<f32>(&scene).unwrap();
            let samples = &wanted.layers[0];
            assert_eq!(samples.kind, LayerKind::Samples);
            assert_eq!(samples.values, found.layers[0].values, "{target} {order:?}");
            let what = format!("eye in a slice, to {target}, {order:?}");
            Worst::between(what, found.width, &wanted.pixels, &found.pixels, 1e-5).assert_holds();
        }
    }
}

#[test]
fn crop_and_clip_planes_cut_what_their_references_cut() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let normal = dvec3(1.0, 0.4, -0.3).normalize();
    let plane = ClipPlane {
        normal,
        offset: normal.dot(GRID().center()) - 2.7,
    };
    for shot in oblique_shots(GRID(), Mode::Composite) {
        let shot = shot.with(|settings| {
            settings.crop = Some([dvec3(2.3, 1.7, -4.0), dvec3(15.2, 99.0, 11.9)]);
            settings.clip_planes = vec![plane];
        });
        check(&mut renderer, &volume, &transfer, &shot, "cut");
    }
}

#[test]
fn both_color_spaces_and_steps_are_classified_as_their_references_do() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let steps = TransferFunction {
        interpolation: Interpolation::Step,
        ..ramps()
    };
    for transfer in [ramps(), steps] {
        for color_space in [ColorSpace::Linear, ColorSpace::Display] {
            for mode in [Mode::Composite, Mode::Mip] {
                for shot in oblique_shots(GRID(), mode) {
                    let shot = shot.with(|settings| settings.color_space = color_space);
                    let what = format!("{:?} {color_space:?}", transfer.interpolation);
                    check(&mut renderer, &volume, &transfer, &shot, &what);
                }
            }
        }
    }
}

#[test]
fn every_type_of_voxel_is_read_as_its_reference_reads_it() {
    let dims = GRID().dims;
    let values = volume_of(dims, sheared_affine(), waves).voxels;
    let codes = |scale: f32| {
        (0..values.len())
            .map(move |i| (i, scale))
            .map(|(i, scale)| values.stored(i) * scale)
    };
    let types = [
        (
            Voxels::U8(codes(200.0).map(|v| v as u8).collect()),
            1.0 / 200.0,
            0.0,
        ),
        (
            Voxels::I8(codes(200.0).map(|v| (v - 100.0) as i8).collect()),
            1.0 / 200.0,
            0.5,
        ),
        (
            Voxels::U16(codes(60000.0).map(|v| v as u16).collect()),
            1.0 / 60000.0,
            0.0,
        ),
        (
            Voxels::I16(codes(4000.0).map(|v| (v - 1024.0) as i16).collect()),
            1.0 / 4000.0,
            0.256,
        ),
        (
            Voxels::F16(codes(1.0).map(half::f16::from_f32).collect()),
            1.0,
            0.0,
        ),
    ];
    let transfer = ramps();
    for (voxels, slope, intercept) in types {
        let what = format!("{:?}", voxels.voxel_type());
        let rescale = Rescale { slope, intercept };
        // A code that is there now and then: holes take part.
        let fill = f64::from(voxels.stored(100));
        let volume =
            Volume::from_voxels(dims, sheared_affine(), voxels, rescale, Some(fill)).unwrap();
        let mut renderer = Renderer::new(device(), &volume).unwrap();
        for shot in oblique_shots(GRID(), Mode::Composite) {
            check(&mut renderer, &volume, &transfer, &shot, &what);
        }
    }
}

#[test]
fn fewer_and_more_samples_are_those_of_the_reference() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for samples_per_voxel in [0.3, 0.9, 4.7] {
        for shot in oblique_shots(GRID(), Mode::Composite) {
            let shot = shot.with(|settings| settings.samples_per_voxel = samples_per_voxel);
            check(
                &mut renderer,
                &volume,
                &transfer,
                &shot,
                &format!("{samples_per_voxel}"),
            );
        }
    }
}

#[test]
fn a_camera_along_an_axis_sees_what_its_reference_computes() {
    // Rays along faces and edges of voxels, and slices seen from their rim.
    let grid = Grid {
        dims: [12, 10, 8],
        world_from_voxel: glam::DAffine3::IDENTITY,
    };
    let volume = volume_of(grid.dims, grid.world_from_voxel, waves);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for axis in DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]) {
        for projection in projections(&grid) {
            let camera = Camera {
                eye: grid.center() - 30.0 * axis,
                target: grid.center(),
                up: axis.yzx(),
                projection,
                zoom: 1.0,
            };
            for shot in oblique_shots(grid, Mode::Composite).into_iter().take(6) {
                let shot = PictureCase { camera, ..shot };
                check(
                    &mut renderer,
                    &volume,
                    &transfer,
                    &shot,
                    &format!("along {axis}"),
                );
            }
        }
    }
}
