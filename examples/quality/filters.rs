//! Filters: the error on the signal of Marschner and Lobb, and what a frame takes.
//!
//! RMS of (filtered - exact) at 40 voxels an axis over [-1, 1], at points of [-0.8, 0.8], sampled on the device: each
//! ray takes one sample, in the middle of a slab of half a voxel.

use glam::{DAffine3, DQuat, DVec3};
use std::error::Error;
use stratavox::camera::{BoundingSphere, Camera, Lens, Projection, View};
use stratavox::gpu::{DeviceChoice, Headless, Options};
use stratavox::offscreen::Renderer;
use stratavox::picture::LayerKind;
use stratavox::scene::Scene;
use stratavox::technique::{Filter, Mode, Settings};
use stratavox::transfer::{Classified, Window};
use stratavox::volume::field::{Field, MarschnerLobb};
use stratavox::volume::{Limits, Pick, Rescale, Volume, Voxels, phantom};

/// Word, filter, and the RMS error that an independent program found.
const FILTERS: [(&str, Filter, f64); 7] = [
    ("nearest", Filter::Nearest, 0.0474),
    ("linear", Filter::Linear, 0.0328),
    ("quadratic", Filter::Quadratic, 0.0185),
    ("cubic", Filter::Cubic, 0.0147),
    ("quadratic-smooth", Filter::QuadraticSmooth, 0.0391),
    ("cubic-smooth", Filter::CubicSmooth, 0.0452),
    ("catmull-rom", Filter::CatmullRom, 0.0233),
];

const SIDE: u32 = 40;
const SLABS: u32 = 50;
const EXTENT: [u32; 2] = [256, 256];
const FRAMES: usize = 5;

pub fn print() -> Result<(), Box<dyn Error>> {
    let signal = signal();
    let source = phantom::open("phantom:head,n=128", &Limits::default())?;
    let whole = source.header().whole();
    let head = Volume::read(source.as_ref(), Pick::default(), whole, &Limits::default())?;

    let device = Headless::new(&DeviceChoice::Default, &Options::default())?;
    let [width, height] = EXTENT;
    println!(
        "{}, head of 128^3 voxels at {width}x{height} pixels\n",
        device.gpu().identity().name
    );
    println!("| filter | RMS error | known | by fetches | ms a frame | by fetches |");
    println!("|---|---|---|---|---|---|");
    let mut errors = Renderer::new(device, &signal)?;
    let mut rows = Vec::new();
    for (word, filter, known) in FILTERS {
        let found = [false, true].map(|conformance| rms(&mut errors, &signal, filter, conformance));
        let [fast, exact] = found;
        rows.push((word, filter, known, fast?, exact?));
    }
    let mut frames = Renderer::new(errors.into_device(), &head)?;
    for (word, filter, known, fast, exact) in rows {
        let times =
            [false, true].map(|by_fetches| frame_ms(&mut frames, &head, filter, by_fetches));
        let [fast_ms, exact_ms] = times;
        let (fast_ms, exact_ms) = (fast_ms?, exact_ms?);
        println!("| {word} | {fast:.4} | {known:.4} | {exact:.4} | {fast_ms:.1} | {exact_ms:.1} |");
    }
    Ok(())
}

/// The centres of the outermost voxels lie at -1 and 1.
fn world_from_voxel() -> DAffine3 {
    let spacing = 2.0 / f64::from(SIDE - 1);
    let corner = DVec3::splat(-1.0 - 0.5 * spacing);
    DAffine3::from_scale_rotation_translation(DVec3::splat(spacing), DQuat::IDENTITY, corner)
}

fn signal() -> Volume {
    let field = MarschnerLobb::default();
    let numbers = (0..SIDE.pow(3)).map(|i| {
        let index = [i % SIDE, i / SIDE % SIDE, i / (SIDE * SIDE)];
        let voxel = DVec3::from_array(index.map(f64::from)) + 0.5;
        field.value(world_from_voxel().transform_point3(voxel)) as f32
    });
    let voxels = Voxels::F32(numbers.collect());
    let rescale = Rescale::default();
    Volume::from_voxels([SIDE; 3], world_from_voxel(), voxels, rescale, None)
        .expect("as many voxels as dims say")
}

fn rms(
    renderer: &mut Renderer,
    signal: &Volume,
    filter: Filter,
    conformance: bool,
) -> Result<f64, Box<dyn Error>> {
    let field = MarschnerLobb::default();
    let camera = Camera {
        eye: -3.0 * DVec3::Z,
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Orthographic { view_height: 1.6 },
        zoom: 1.0,
    };
    let transfer = Window::of_range(signal.value_range).grey(Classified::Projection);
    let extent_pixels = [100, 100];
    let rays = camera.rays(extent_pixels);
    let side = f64::from(SIDE);
    let (mut squares, mut count) = (0.0, 0);
    for slab in 0..SLABS {
        let middle = -0.8 + 1.6 * (f64::from(slab) + 0.5) / f64::from(SLABS);
        let voxel = world_from_voxel()
            .inverse()
            .transform_point3(middle * DVec3::Z);
        let crop = [
            DVec3::new(0.0, 0.0, voxel.z - 0.25),
            DVec3::new(side, side, voxel.z + 0.25),
        ];
        let settings = Settings {
            mode: Mode::Mip,
            filter,
            conformance,
            crop: Some(crop),
            ..Settings::default()
        };
        let scene = Scene {
            beside: Default::default(),
            volume: signal,
            transfer: Some(&transfer),
            camera: &camera,
            extent_pixels,
            settings: &settings,
        };
        let found = renderer.render(&scene, &[LayerKind::Value])?.picture;
        for (i, value) in found.layers[0].values.iter().enumerate() {
            let pixel = [i % 100, i / 100].map(|n| n as f64 + 0.5);
            let (origin, _) = rays.at(pixel[0], pixel[1]);
            let point = DVec3::new(origin.x, origin.y, middle);
            squares += (f64::from(*value) - field.value(point)).powi(2);
            count += 1;
        }
    }
    Ok((squares / f64::from(count)).sqrt())
}

/// The middle of some frames, on the device where it has a clock.
fn frame_ms(
    renderer: &mut Renderer,
    head: &Volume,
    filter: Filter,
    by_fetches: bool,
) -> Result<f64, Box<dyn Error>> {
    let bounds = BoundingSphere::of_grid(&head.world_from_voxel, head.dims);
    let lens = Lens::Perspective { fov_degrees: 30.0 };
    let facing = View::Left.orbit();
    let camera = Camera::orbit(&bounds, bounds.center, facing, None, lens, EXTENT)?;
    let transfer = Window::of_range(head.value_range).grey(Classified::Projection);
    let settings = Settings {
        // One value a ray: what a frame takes is reading the volume.
        mode: Mode::Mip,
        filter,
        conformance: by_fetches,
        ..Settings::default()
    };
    let scene = Scene {
        beside: Default::default(),
        volume: head,
        transfer: Some(&transfer),
        camera: &camera,
        extent_pixels: EXTENT,
        settings: &settings,
    };
    renderer.render(&scene, &[])?;
    let mut times = Vec::new();
    for _ in 0..FRAMES {
        let start = std::time::Instant::now();
        let rendered = renderer.render(&scene, &[])?;
        times.push(
            rendered
                .gpu_ms
                .unwrap_or(1e3 * start.elapsed().as_secs_f64()),
        );
    }
    times.sort_by(f64::total_cmp);
    Ok(times[FRAMES / 2])
}
