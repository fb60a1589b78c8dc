//! A picture that is drawn in parts is the same to the bit as one that is drawn at once, and can be stopped between
//! two of them.

mod parts;
mod stopped;

use crate::shared::{
    device_with, oblique_camera, projections, ramps, sheared_affine, volume_of, waves,
};
use glam::{DAffine3, dvec3};
use stratavox::gpu::Caps;
use stratavox::offscreen::Renderer;
use stratavox::picture::{LayerKind, Picture};
use stratavox::scene::Scene;
use stratavox::technique::splat::Sheets;
use stratavox::technique::{
    AmbientOcclusion, Filter, GradientStorage, Jitter, Lattice, Level, Light, Mode, Order, PerMode,
    Settings, Shading, Shadows, Technique,
};
use stratavox::volume::Volume;

/// Neither side is a multiple of a workgroup's.
const EXTENT: [u32; 2] = [27, 21];

fn small() -> Volume {
    volume_of([17, 21, 13], sheared_affine(), waves)
}

/// One submission for each pass.
const AT_ONCE: f64 = f64::INFINITY;
/// One workgroup in each submission.
const IN_SMALLEST_PARTS: f64 = 0.0;

/// The picture as it is for each of these, drawn by renderers that make all they need anew, and how many submissions
/// each took.
fn drawn(
    caps: Caps,
    volume: &Volume,
    settings: &Settings,
    (has_function, layers): (bool, &[LayerKind]),
    submission_ms: &[f64],
) -> Vec<(Picture, u64)> {
    let grid = volume.grid();
    let camera = oblique_camera(&grid, projections(&grid)[1]);
    let function = ramps();
    let scene = Scene {
        beside: Default::default(),
        volume,
        transfer: has_function.then_some(&function),
        camera: &camera,
        extent_pixels: EXTENT,
        settings,
    };
    let mut pictures = Vec::new();
    let mut device = device_with(caps);
    for &ms in submission_ms {
        let before = device.submissions().count;
        let mut renderer = Renderer::new(device, volume).unwrap();
        renderer.set_submission_ms(ms);
        let picture = renderer.render(&scene, layers).unwrap().picture;
        device = renderer.into_device();
        pictures.push((picture, device.submissions().count - before));
    }
    pictures
}

fn bits(picture: &Picture) -> Vec<u32> {
    let layers = picture.layers.iter().flat_map(|layer| &layer.values);
    let numbers = picture.pixels.as_flattened().iter().chain(layers);
    numbers.map(|number| number.to_bits()).collect()
}

/// The same to the bit in parts and at once, of a picture that shows something; and there were parts.
#[track_caller]
fn assert_same(
    caps: Caps,
    volume: &Volume,
    settings: &Settings,
    (has_function, layers): (bool, &[LayerKind]),
    what: &str,
) {
    let wanted = (has_function, layers);
    let made = [AT_ONCE, IN_SMALLEST_PARTS];
    let [(whole, few), (parts, many)] = &drawn(caps, volume, settings, wanted, &made)[..] else {
        unreachable!("two pictures")
    };
    let (few, many) = (*few, *many);
    let blocks = u64::from(EXTENT[0].div_ceil(8) * EXTENT[1].div_ceil(8));
    // The pass of the technique, and where that leaves a value a resolve.
    let passes = 1 + u64::from(settings.mode.is_projection());
    assert!(many >= few + passes * (blocks - 1), "{what}: {few}, {many}");
    let first = whole.pixels[0];
    assert!(
        whole.pixels.iter().any(|&p| p != first),
        "{what}: one colour"
    );
    assert!(bits(whole) == bits(parts), "{what}: other bits");
}

fn with_mode(mode: Mode) -> Settings {
    let level = |value, opacity| Level {
        value,
        srgb: [0.9, 0.5, 0.2],
        opacity,
    };
    Settings {
        mode,
        per_mode: PerMode {
            levels: vec![level(0.4, 0.4), level(0.7, 1.0)],
            lmip_threshold: 0.6,
            ..PerMode::default()
        },
        ..Settings::default()
    }
}

#[test]
fn patches_are_drawn_in_runs_of_slices() {
    let volume = small();
    for order in [Order::FrontToBack, Order::BackToFront] {
        let settings = Settings {
            technique: Technique::Slices3d,
            order,
            samples_per_voxel: 30.0,
            ..Settings::default()
        };
        let made = [AT_ONCE, IN_SMALLEST_PARTS];
        let pictures = drawn(Caps::UNLIMITED, &volume, &settings, (true, &[]), &made);
        let [(whole, few), (parts, many)] = &pictures[..] else {
            unreachable!("two pictures")
        };
        assert!(*many >= few + 2, "{order:?}: {few}, {many}");
        assert!(whole.pixels.iter().any(|pixel| pixel[3] > 0.0));
        assert!(bits(whole) == bits(parts), "{order:?}: other bits");
    }
}

#[test]
fn every_mode_of_the_ray_caster_is_the_same_in_parts() {
    use LayerKind::*;
    let volume = small();
    let cases: [(Mode, bool, &[LayerKind]); 9] = [
        (Mode::Composite, true, &[Depth, Transmittance, Samples]),
        (Mode::Mip, false, &[Value, Samples]),
        (Mode::Minip, true, &[Depth]),
        (Mode::Average, true, &[]),
        (Mode::Xray, false, &[]),
        (Mode::Lmip, true, &[]),
        (Mode::AttenuatedMip, true, &[]),
        (Mode::Iso, true, &[Value, Depth]),
        (Mode::Mida, true, &[]),
    ];
    for (mode, has_function, layers) in cases {
        let settings = with_mode(mode);
        let wanted = (has_function, layers);
        let what = format!("{mode:?}");
        assert_same(Caps::UNLIMITED, &volume, &settings, wanted, &what);
    }
}

#[test]
fn so_are_jittered_rays_several_rays_a_pixel_slabs_planes_splats_and_exact_maxima() {
    let volume = small();
    type Change<'a> = (&'a str, &'a dyn Fn(&mut Settings));
    let changes: [Change; 13] = [
        ("jitter", &|s| {
            s.lattice = Lattice::Jitter;
            s.jitter = Jitter { seed: 3, frame: 5 };
        }),
        ("uneven rays", &|s| {
            s.rays_per_side = 2;
            s.uneven_rays = true;
        }),
        ("slabs", &|s| s.preintegrated = true),
        ("planes", &|s| s.lattice = Lattice::Planes),
        ("main axes", &|s| s.lattice = Lattice::Bresenham),
        ("a warp", &|s| s.technique = Technique::ShearWarp),
        ("a warp of maxima", &|s| {
            s.technique = Technique::ShearWarp;
            s.mode = Mode::Mip;
        }),
        ("splats", &|s| s.technique = Technique::Splat),
        ("splats in slices", &|s| {
            s.technique = Technique::Splat;
            s.splat.sheets = Sheets::Axis;
        }),
        ("a maximum of splats", &|s| {
            s.technique = Technique::Splat;
            s.mode = Mode::Mip;
        }),
        ("sums of splats", &|s| {
            s.technique = Technique::Splat;
            s.mode = Mode::Xray;
        }),
        ("an exact maximum", &|s| {
            s.mode = Mode::Mip;
            s.per_mode.exact_maximum = true;
        }),
        ("a depth cue", &|s| {
            s.mode = Mode::Mip;
            s.per_mode.depth_cue = 0.5;
        }),
    ];
    for (what, change) in changes {
        let mut settings = Settings::default();
        change(&mut settings);
        let wanted: (_, &[_]) = (true, &[LayerKind::Samples]);
        assert_same(Caps::UNLIMITED, &volume, &settings, wanted, what);
    }
}

#[test]
fn so_are_slices_in_both_orders_and_their_counts_of_samples() {
    let volume = small();
    let cases = [
        (Technique::Slices3d, Mode::Composite, Order::BackToFront),
        (Technique::Slices3d, Mode::Composite, Order::FrontToBack),
        (Technique::Slices3d, Mode::Mip, Order::BackToFront),
        (Technique::Slices2d, Mode::Composite, Order::FrontToBack),
        (Technique::Slices2d, Mode::Average, Order::BackToFront),
    ];
    for (technique, mode, order) in cases {
        for preintegrated in [false, true] {
            if preintegrated && mode != Mode::Composite {
                continue;
            }
            let settings = Settings {
                technique,
                order,
                preintegrated,
                skip: false,
                ..with_mode(mode)
            };
            let what = format!("{technique:?} {mode:?} {order:?} {preintegrated}");
            let wanted: (_, &[_]) = (true, &[LayerKind::Samples]);
            assert_same(Caps::UNLIMITED, &volume, &settings, wanted, &what);
        }
    }
    let smooth = Settings {
        technique: Technique::Slices2d,
        smooth: true,
        skip: false,
        ..Settings::default()
    };
    assert_same(Caps::UNLIMITED, &volume, &smooth, (true, &[]), "smooth");
}

#[test]
fn so_are_pictures_of_several_bricks() {
    let caps = Caps {
        max_image_dimension_3d: 13,
        max_image_array_layers: 8,
        ..Caps::UNLIMITED
    };
    let volume = volume_of([17, 9, 7], sheared_affine(), waves);
    let cases = [
        (Technique::Raycast, Mode::Composite),
        (Technique::Raycast, Mode::Mip),
        (Technique::Slices3d, Mode::Composite),
        (Technique::Slices2d, Mode::Minip),
    ];
    for (technique, mode) in cases {
        let settings = Settings {
            technique,
            ..with_mode(mode)
        };
        let what = format!("bricks, {technique:?} {mode:?}");
        let wanted: (_, &[_]) = (true, &[LayerKind::Samples]);
        assert_same(caps, &volume, &settings, wanted, &what);
    }
}

#[test]
fn so_are_batches_of_slices_where_floats_cannot_be_blended() {
    let caps = Caps {
        float32_blend: false,
        ..Caps::UNLIMITED
    };
    // Three batches of slices.
    let volume = volume_of(
        [6, 5, 150],
        DAffine3::from_scale(dvec3(9.0, 9.0, 1.0)),
        waves,
    );
    for order in [Order::BackToFront, Order::FrontToBack] {
        let settings = Settings {
            technique: Technique::Slices2d,
            order,
            stack: Some(2),
            ..Settings::default()
        };
        let wanted: (_, &[_]) = (true, &[LayerKind::Samples]);
        assert_same(caps, &volume, &settings, wanted, "batches");
    }
}

#[test]
fn so_are_pictures_that_need_light_volumes_kept_gradients_and_macro_cells_of_coefficients() {
    let shading = Shading {
        shadows: Shadows::Volume {
            light_size_degrees: 3.0,
        },
        lights: vec![Light::of_world(dvec3(1.0, -2.0, 0.7), [1.0, 0.9, 0.8])],
        ..Shading::default()
    };
    let bricks = Caps {
        max_image_dimension_3d: 13,
        ..Caps::UNLIMITED
    };
    let lit = Settings {
        shading: Some(shading),
        ambient_occlusion: Some(AmbientOcclusion {
            strength: 0.8,
            radius_world: None,
        }),
        ..Settings::default()
    };
    let kept = Settings {
        shading: Some(Shading::default()),
        gradient_storage: GradientStorage::Precomputed,
        ..Settings::default()
    };
    let cubic = Settings {
        filter: Filter::Cubic,
        mode: Mode::Mip,
        ..Settings::default()
    };
    let volume = volume_of([15, 9, 6], sheared_affine(), waves);
    for (caps, settings, what) in [
        (bricks, &lit, "light volume"),
        (bricks, &kept, "kept gradients"),
        (Caps::UNLIMITED, &cubic, "macro cells"),
    ] {
        assert_same(caps, &volume, settings, (true, &[]), what);
    }
}

#[test]
fn so_are_half_angle_slices() {
    let volume = volume_of([9, 8, 7], sheared_affine(), waves);
    let settings = Settings {
        technique: Technique::Slices3d,
        order: Order::FrontToBack,
        shading: Some(Shading {
            shadows: Shadows::HalfAngle,
            lights: vec![Light::of_world(dvec3(1.0, -2.0, 0.7), [1.0, 0.9, 0.8])],
            ..Shading::plain()
        }),
        ..Settings::default()
    };
    assert_same(Caps::UNLIMITED, &volume, &settings, (true, &[]), "shadows");
}

#[test]
fn parts_of_any_size_that_times_happen_to_ask_for_make_the_same_picture() {
    let volume = small();
    let settings = Settings::default();
    let wanted: (_, &[_]) = (true, &[LayerKind::Samples]);
    let times = [AT_ONCE, 1e-3, 0.1, 0.5, 2.0];
    let found = drawn(Caps::UNLIMITED, &volume, &settings, wanted, &times);
    for ((picture, _), ms) in found.iter().zip(times) {
        assert!(bits(picture) == bits(&found[0].0), "{ms} ms");
    }
}

#[test]
fn a_small_picture_is_one_submission_as_before() {
    let volume = small();
    let settings = Settings::default();
    let times = [AT_ONCE, 100.0];
    let found = drawn(Caps::UNLIMITED, &volume, &settings, (true, &[]), &times);
    assert_eq!(found[0].1, found[1].1);
}
