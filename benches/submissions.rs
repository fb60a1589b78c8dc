//! What it costs that no submission takes long: pictures in parts against the same at once, drawn in turn.
//!
//! `longest` is the longest submission of all that a renderer did; `parts` are submissions of the first picture and of
//! a later one.

use std::error::Error;
use std::time::Instant;
use stratavox::camera::{BoundingSphere, Camera, Lens, View};
use stratavox::gpu::{DeviceChoice, Headless, Options};
use stratavox::offscreen::Renderer;
use stratavox::scene::Scene;
use stratavox::technique::{Mode, Settings, Shading, Technique};
use stratavox::transfer::{Classified, Window};
use stratavox::volume::{Limits, TimeComponent, Volume, phantom};

/// A picture, of how many pixels a side, and how often it is drawn each way.
struct Case {
    name: &'static str,
    volume: &'static str,
    side: u32,
    rounds: usize,
    settings: fn() -> Settings,
}

const CASES: &[Case] = &[
    Case {
        name: "small",
        volume: "phantom:head,n=128",
        side: 256,
        rounds: 15,
        settings: Settings::default,
    },
    Case {
        name: "usual",
        volume: "phantom:head,n=256",
        side: 512,
        rounds: 9,
        settings: Settings::default,
    },
    Case {
        name: "usual, MIP",
        volume: "phantom:head,n=256",
        side: 512,
        rounds: 9,
        settings: || Settings {
            mode: Mode::Mip,
            ..Settings::default()
        },
    },
    Case {
        name: "usual, slices",
        volume: "phantom:head,n=256",
        side: 512,
        rounds: 5,
        settings: || Settings {
            technique: Technique::Slices3d,
            ..Settings::default()
        },
    },
    Case {
        name: "all seen, with light",
        volume: "phantom:fog,n=128",
        side: 512,
        rounds: 3,
        settings: || Settings {
            shading: Some(Shading::default()),
            skip: false,
            ..Settings::default()
        },
    },
    Case {
        name: "worst",
        volume: "phantom:fog,n=512",
        side: 2048,
        rounds: 1,
        settings: || Settings {
            skip: false,
            ..Settings::default()
        },
    },
];

fn main() -> Result<(), Box<dyn Error>> {
    // The names of cases, none for all.
    let wanted: Vec<_> = std::env::args().skip(1).collect();
    println!(
        "{:<22} {:>24} {:>24} {:>12} {:>20}",
        "", "at once: first, later", "in parts: first, later", "parts", "longest: once, parts"
    );
    for case in CASES {
        let names = wanted.iter().filter(|word| !word.starts_with('-'));
        if names.clone().count() == 0 || names.clone().any(|name| name == case.name) {
            measure(case)?;
        }
    }
    Ok(())
}

fn measure(case: &Case) -> Result<(), Box<dyn Error>> {
    let limits = Limits::default();
    let source = phantom::open(case.volume, &limits)?;
    let whole = source.header().whole();
    let volume = Volume::read(source.as_ref(), TimeComponent::default(), whole, &limits)?;
    let settings = (case.settings)();
    let extent = [case.side; 2];
    let bounds = BoundingSphere::of_grid(&volume.world_from_voxel, volume.dims);
    let lens = Lens::Perspective { fov_degrees: 30.0 };
    let facing = View::Left.orbit();
    let camera = Camera::orbit(&bounds, bounds.center, facing, None, lens, extent)?;
    let classified = match settings.mode {
        Mode::Composite => Classified::Samples,
        _ => Classified::Projection,
    };
    let transfer = Window::of_range(volume.value_range).grey(classified);
    let scene = Scene {
        beside: Default::default(),
        volume: &volume,
        transfer: Some(&transfer),
        camera: &camera,
        extent_pixels: extent,
        settings: &settings,
    };
    let device = || Headless::new(&DeviceChoice::Default, &Options::default());
    let mut ways = [
        Renderer::new(device()?, &volume)?,
        Renderer::new(device()?, &volume)?,
    ];
    ways[0].set_submission_ms(f64::INFINITY);
    let mut times: [Vec<f64>; 2] = Default::default();
    let mut parts = Vec::new();
    let mut pictures = Vec::new();
    for way in &mut ways {
        way.upload(&scene)?;
        way.prepare_pipelines(&scene)?;
        way.prepare_empty_space(&scene)?;
    }
    for round in 0..=case.rounds {
        for (way, times) in ways.iter_mut().zip(&mut times) {
            let before = way.device().submissions().count;
            let start = Instant::now();
            let picture = way.render(&scene, &[])?.picture;
            times.push(1e3 * start.elapsed().as_secs_f64());
            parts.push(way.device().submissions().count - before);
            if round == 0 {
                pictures.push(picture.pixels);
            }
        }
    }
    assert!(pictures[0] == pictures[1], "{}: another picture", case.name);
    let firsts = [0, 1].map(|way| times[way][0]);
    let later = times.map(|mut times| {
        let later = &mut times[1..];
        later.sort_by(f64::total_cmp);
        later[later.len() / 2]
    });
    let pair = |[a, b]: [f64; 2]| format!("{a:.0}, {b:.0} ms");
    println!(
        "{:<22} {:>24} {:>24} {:>12} {:>20}",
        case.name,
        pair([firsts[0], later[0]]),
        pair([firsts[1], later[1]]),
        format!("{}, {}", parts[1], parts[3]),
        pair([0, 1].map(|way: usize| ways[way].device().submissions().longest_ms)),
    );
    Ok(())
}
