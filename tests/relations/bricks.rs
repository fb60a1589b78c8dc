//! A volume in many bricks is the same picture as in one.

use crate::shared::{
    device, device_with, oblique_camera, projections, ramps, sheared_affine, volume_of, waves,
};
use stratavox::camera::{Camera, Projection};
use stratavox::gpu::Caps;
use stratavox::offscreen::Renderer;
use stratavox::picture::LayerKind;
use stratavox::scene::Scene;
use stratavox::technique::{
    ClipPlane, CutFaces, Filter, GradientFilter, Lattice, Level, Mode, Order, Settings, Shading,
    Technique,
};
use stratavox::volume::Volume;

/// Caps under which a volume of 17 x 21 x 14 voxels takes bricks along every axis.
fn small() -> Caps {
    Caps {
        max_image_dimension_3d: 13,
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
    const MODES_OF_BRICKS: [(Mode, Filter, f64); 3] = [
        (Mode::Composite, Filter::Linear, 1.0),
        (Mode::Xray, Filter::Nearest, 2.3),
        // Heights of every second voxel's border, some of which are borders of bricks.
        (Mode::Mip, Filter::Linear, 0.5),
    ];
    let along_axes = MODES_OF_BRICKS.map(|(mode, filter, samples_per_voxel)| Settings {
        mode,
        filter,
        samples_per_voxel,
        lattice: Lattice::Bresenham,
        conformance: true,
        ..Settings::default()
    });
    let warped = MODES_OF_BRICKS.map(|(mode, filter, samples_per_voxel)| Settings {
        technique: Technique::ShearWarp,
        mode,
        filter,
        samples_per_voxel,
        conformance: true,
        ..Settings::default()
    });
    let all = techniques.into_iter().flat_map(of_technique);
    all.chain(along_axes).chain(warped).collect()
}

/// Gradients reach one voxel further than their filter, or as far as operators of their own.
fn lit_settings() -> Vec<Settings> {
    use GradientFilter::{Analytic, Central, Cubic, Sobel};
    let lit = |(technique, filter, gradient_filter)| Settings {
        technique,
        filter,
        gradient_filter,
        shading: Some(Shading::default()),
        conformance: true,
        ..Settings::default()
    };
    let turns = [
        (Technique::Raycast, Filter::Cubic, Central),
        (Technique::Slices3d, Filter::Linear, Central),
        (Technique::Slices2d, Filter::Cubic, Central),
        (Technique::Slices2d, Filter::Nearest, Central),
        (Technique::Raycast, Filter::Linear, Cubic),
        (Technique::Slices3d, Filter::CatmullRom, Analytic),
        (Technique::Slices2d, Filter::Cubic, Cubic),
        (Technique::Slices2d, Filter::Nearest, Sobel),
    ];
    turns.map(lit).into()
}

fn assert_same_picture(volume: &Volume, camera: &Camera, settings: Vec<Settings>) {
    let transfer = ramps();
    let mut whole = Renderer::new(device(), volume).unwrap();
    let mut bricked = Renderer::new(device_with(small()), volume).unwrap();
    for settings in settings {
        // What rays leave out depends on the bricks: tests/relations/skipping.rs has pictures of that. Here all samples are
        // counted.
        let settings = Settings {
            skip: false,
            ..settings
        };
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
        // Cells at a border of bricks are looked at from both sides.
        if !settings.per_mode.exact_maximum {
            assert!(wanted.layers == found.layers, "{settings:?}: samples");
        }
    }
}

#[test]
fn bricks_leave_a_picture_bit_identical() {
    let volume = volume_of([17, 21, 14], sheared_affine(), waves);
    for projection in projections(&volume.grid()) {
        assert_same_picture(
            &volume,
            &oblique_camera(&volume.grid(), projection),
            settings(),
        );
    }
}

#[test]
fn bricks_leave_a_picture_bit_identical_from_inside() {
    let volume = volume_of([17, 21, 14], sheared_affine(), waves);
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
    // A base plane has the eye on one side.
    let is_seen = |settings: &Settings| settings.technique != Technique::ShearWarp;
    let settings = settings().into_iter().filter(is_seen).collect();
    assert_same_picture(&volume, &camera, settings);
}

/// Few holes: a cubic sample has no data where one of 64 voxels has none.
fn with_holes() -> Volume {
    let mut volume = volume_of([17, 21, 14], sheared_affine(), waves);
    let mask = (0..17 * 21 * 14)
        .map(|i: u32| u8::from(!i.is_multiple_of(101) && i % 211 != 3))
        .collect();
    volume.validity = Some(mask);
    volume
}

#[test]
fn bricks_leave_holes_where_they_are() {
    let volume = with_holes();
    let camera = oblique_camera(&volume.grid(), projections(&volume.grid())[1]);
    assert_same_picture(&volume, &camera, settings());
}

#[test]
fn bricks_leave_light_as_it_falls() {
    let volume = with_holes();
    let camera = oblique_camera(&volume.grid(), projections(&volume.grid())[0]);
    assert_same_picture(&volume, &camera, lit_settings());
}

fn by_rays(mode: Mode, filter: Filter) -> Settings {
    let mut settings = Settings {
        mode,
        filter,
        conformance: true,
        ..Settings::default()
    };
    let level = |value, opacity| Level {
        value,
        srgb: [0.9, 0.4, 0.2],
        opacity,
    };
    settings.per_mode.levels = vec![level(0.4, 0.5), level(0.55, 0.5), level(0.7, 1.0)];
    settings.per_mode.lmip_threshold = 0.6;
    settings.per_mode.unit_values = [0.1, 0.9];
    settings.per_mode.mida_gamma = -0.25;
    settings
}

/// A row for each way that brings something of its own along a ray.
fn ways(center: glam::DVec3) -> Vec<Settings> {
    let normal = glam::dvec3(-1.0, 0.5, 0.2);
    let mut ways: Vec<_> = [
        (Mode::Lmip, Filter::Linear),
        (Mode::AttenuatedMip, Filter::Nearest),
        (Mode::Mida, Filter::Linear),
    ]
    .map(|(mode, filter)| by_rays(mode, filter))
    .into();
    ways.extend(
        [Technique::Raycast, Technique::Slices3d, Technique::Slices2d].map(|technique| Settings {
            technique,
            preintegrated: true,
            samples_per_voxel: 2.0,
            ..by_rays(Mode::Composite, Filter::Linear)
        }),
    );
    let mut exact = by_rays(Mode::Mip, Filter::Linear);
    exact.per_mode.exact_maximum = true;
    ways.push(exact);
    let mut mixed = by_rays(Mode::Mida, Filter::Linear);
    mixed.per_mode.mida_gamma = 0.5;
    ways.push(mixed);
    let cut = |settings: Settings| Settings {
        crop: Some([glam::dvec3(0.0, 4.3, 0.0), glam::dvec3(12.2, 21.0, 9.7)]),
        cut_faces: Some(CutFaces::Own),
        ..settings
    };
    ways.push(cut(by_rays(Mode::Composite, Filter::Linear)));
    ways.push(cut(Settings {
        preintegrated: true,
        samples_per_voxel: 2.0,
        clip_planes: vec![ClipPlane {
            normal,
            offset: normal.dot(center) - 2.0,
        }],
        ..by_rays(Mode::Composite, Filter::Linear)
    }));
    ways
}

/// Surfaces are refined between two ends, of which one may lie in the brick before.
fn surfaces() -> Vec<Settings> {
    let lit = |filter, samples_per_voxel| Settings {
        shading: Some(Shading::default()),
        samples_per_voxel,
        ..by_rays(Mode::Iso, filter)
    };
    vec![
        lit(Filter::Linear, 1.0),
        lit(Filter::Cubic, 3.0),
        Settings {
            crop: Some([glam::dvec3(1.5, 4.3, 0.0), glam::dvec3(12.2, 21.0, 9.7)]),
            ..by_rays(Mode::Iso, Filter::Linear)
        },
    ]
}

#[test]
fn bricks_leave_every_way_along_a_ray_as_it_is() {
    let volume = with_holes();
    let camera = oblique_camera(&volume.grid(), projections(&volume.grid())[1]);
    assert_same_picture(&volume, &camera, ways(volume.grid().center()));
}

#[test]
fn bricks_leave_no_seam_in_surfaces() {
    let volume = with_holes();
    for projection in projections(&volume.grid()) {
        let camera = oblique_camera(&volume.grid(), projection);
        assert_same_picture(&volume, &camera, surfaces());
    }
}
