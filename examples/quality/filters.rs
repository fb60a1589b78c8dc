//! Filters: the error on the signal of Marschner and Lobb, and what a frame takes.
//!
//! RMS of (filtered - exact), sampled on the device.

use super::marschner_lobb::{camera, heights, signal, slab};
use std::error::Error;
use stratavox::camera::{BoundingSphere, Camera, Lens, View};
use stratavox::gpu::{DeviceChoice, Headless, Options};
use stratavox::offscreen::Renderer;
use stratavox::picture::LayerKind;
use stratavox::scene::Scene;
use stratavox::technique::{Filter, Mode, Settings};
use stratavox::transfer::{Classified, Window};
use stratavox::volume::field::{Field, MarschnerLobb};
use stratavox::volume::{Limits, TimeComponent, Volume, phantom};

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

const SLABS: u32 = 50;
const PIXELS: u32 = 100;
const EXTENT: [u32; 2] = [256, 256];
const FRAMES: usize = 5;

pub fn print() -> Result<(), Box<dyn Error>> {
    let signal = signal();
    let source = phantom::open("phantom:head,n=128", &Limits::default())?;
    let whole = source.header().whole();
    let head = Volume::read(
        source.as_ref(),
        TimeComponent::default(),
        whole,
        &Limits::default(),
    )?;

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

fn rms(
    renderer: &mut Renderer,
    signal: &Volume,
    filter: Filter,
    conformance: bool,
) -> Result<f64, Box<dyn Error>> {
    let field = MarschnerLobb::default();
    let transfer = Window::of_range(signal.value_range).grey(Classified::Projection);
    let (mut squares, mut count) = (0.0, 0);
    for height in heights(SLABS) {
        let (crop, points) = slab(height, PIXELS);
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
            camera: &camera(),
            extent_pixels: [PIXELS; 2],
            settings: &settings,
        };
        let found = renderer.render(&scene, &[LayerKind::Value])?.picture;
        for (value, point) in found.layers[0].values.iter().zip(points) {
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
