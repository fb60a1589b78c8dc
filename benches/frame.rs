//! What a frame takes: each technique and mode on the built-in head, and on a real scan where there is one.
//!
//! `gpu` is the technique alone, `wall` all of [`Renderer::render`]: parameters, submissions, resolve, readback.

mod median;
mod scan;

use median::{median, median_of};
use scan::{SCAN, scan};
use std::error::Error;
use stratavox::camera::{BoundingSphere, Camera, Lens, View};
use stratavox::format;
use stratavox::gpu::{DeviceChoice, Headless, Options};
use stratavox::offscreen::Renderer;
use stratavox::picture::LayerKind;
use stratavox::scene::Scene;
use stratavox::technique::{Mode, Settings, Technique};
use stratavox::transfer::{Classified, Window};
use stratavox::volume::{Limits, Source, TimeComponent, Volume, VolumeSelection, phantom};

const EXTENT: [u32; 2] = [256, 256];
const RUNS: usize = 5;

const TECHNIQUES: [(Technique, &str); 4] = [
    (Technique::Raycast, "raycast"),
    (Technique::Slices3d, "slices-3d"),
    (Technique::Slices2d, "slices-2d"),
    (Technique::ShearWarp, "shear-warp"),
];
const MODES: [(Mode, &str); 5] = [
    (Mode::Composite, "composite"),
    (Mode::Mip, "mip"),
    (Mode::Minip, "minip"),
    (Mode::Average, "average"),
    (Mode::Xray, "xray"),
];

fn main() -> Result<(), Box<dyn Error>> {
    let limits = Limits::default();
    let [width, height] = EXTENT;
    println!("frames of {width}x{height} pixels, median of {RUNS}");
    for name in ["phantom:head,n=128", "phantom:head,n=256"] {
        measure(name, phantom::open(name, &limits)?.as_ref())?;
    }
    let scan = scan();
    if scan.exists() {
        measure(
            SCAN,
            format::open(&scan, &VolumeSelection::default(), &limits)?.as_ref(),
        )?;
    } else {
        println!("skipped: no data at {}", scan.display());
    }
    Ok(())
}

/// One row a technique and mode.
fn measure(name: &str, source: &dyn Source) -> Result<(), Box<dyn Error>> {
    let whole = source.header().whole();
    let volume = Volume::read(source, TimeComponent::default(), whole, &Limits::default())?;
    let device = Headless::new(&DeviceChoice::Default, &Options::default())?;
    let identity = device.gpu().identity();
    let driver = (&identity.driver_name, &identity.driver_info);
    println!(
        "\n{name}, {:?} voxels, {}, {} {}",
        volume.dims, identity.name, driver.0, driver.1
    );
    println!(
        "{:<20} {:>10} {:>10} {:>14}",
        "", "gpu ms", "wall ms", "samples/pixel"
    );
    let mut renderer = Renderer::new(device, &volume)?;
    for (technique, technique_name) in TECHNIQUES {
        for (mode, mode_name) in MODES {
            let row = row(&mut renderer, &volume, technique, mode)?;
            let gpu_ms = row.gpu_ms.map_or("-".into(), |ms| format!("{ms:.1}"));
            println!(
                "{:<20} {gpu_ms:>10} {:>10.1} {:>14.1}",
                format!("{technique_name} {mode_name}"),
                row.wall_ms,
                row.samples
            );
        }
    }
    Ok(())
}

struct Row {
    gpu_ms: Option<f64>,
    wall_ms: f64,
    samples: f64,
}

fn row(
    renderer: &mut Renderer,
    volume: &Volume,
    technique: Technique,
    mode: Mode,
) -> Result<Row, Box<dyn Error>> {
    let bounds = BoundingSphere::of_grid(&volume.world_from_voxel, volume.dims);
    let lens = Lens::Perspective { fov_degrees: 30.0 };
    let facing = View::Left.orbit();
    let camera = Camera::orbit(&bounds, bounds.center, facing, None, lens, EXTENT)?;
    let classified = match mode {
        Mode::Composite => Classified::Samples,
        _ => Classified::Projection,
    };
    let transfer = Window::of_range(volume.value_range).grey(classified);
    let settings = Settings {
        technique,
        mode,
        ..Settings::default()
    };
    let scene = Scene {
        beside: Default::default(),
        volume,
        transfer: Some(&transfer),
        camera: &camera,
        extent_pixels: EXTENT,
        settings: &settings,
    };
    let counted = renderer.render(&scene, &[LayerKind::Samples])?.picture;
    let samples: f64 = counted.layers[0].values.iter().map(|&n| f64::from(n)).sum();
    let mut frames = Vec::new();
    let wall_ms = median_of(RUNS, || frames.push(renderer.render(&scene, &[])));
    // The first one is not counted.
    let gpu_ms = frames.into_iter().skip(1).map(|frame| Ok(frame?.gpu_ms));
    let gpu_ms: Result<Option<Vec<f64>>, stratavox::offscreen::Error> = gpu_ms.collect();
    Ok(Row {
        gpu_ms: gpu_ms?.map(median),
        wall_ms,
        samples: samples / f64::from(EXTENT[0] * EXTENT[1]),
    })
}
