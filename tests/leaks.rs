//! What a renderer makes on a device goes with it, however often.

mod hooked;
mod shared;

use hooked::{Host, Stage, Tape, hooked};
use shared::{device, oblique_camera, projections, ramps, sheared_affine, volume_of, waves};
use std::sync::Arc;
use stratavox::gpu::{Features, Gpu};
use stratavox::offscreen::Renderer;
use stratavox::picture::LayerKind;
use stratavox::scene::Scene;
use stratavox::technique::{Mode, Settings, Technique};

#[test]
fn a_dropped_renderer_leaves_no_vulkan_object() {
    let mut volume = volume_of([9, 8, 7], sheared_affine(), waves);
    volume.validity = Some((0..9 * 8 * 7).map(|i| u8::from(i % 5 != 0)).collect());
    let transfer = ramps();
    let grid = volume.grid();
    let camera = oblique_camera(&grid, projections(&grid)[1]);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let gpu = Arc::clone(renderer.device().gpu());
    for technique in [Technique::Raycast, Technique::Slices3d, Technique::Slices2d] {
        for (mode, transfer) in [(Mode::Composite, Some(&transfer)), (Mode::Xray, None)] {
            let settings = Settings {
                technique,
                mode,
                rays_per_side: 2,
                ..Settings::default()
            };
            let scene = Scene {
                beside: Default::default(),
                volume: &volume,
                transfer,
                camera: &camera,
                extent_pixels: [16, 12],
                settings: &settings,
            };
            renderer.render(&scene, &[LayerKind::Samples]).unwrap();
        }
    }
    let alive: usize = gpu.live_objects().values().sum();
    assert!(alive > 20, "only {alive} objects were ever counted");
    drop(renderer);
    // SAFETY: every submission was waited for.
    unsafe { gpu.retire(u64::MAX) };
    assert_eq!(
        gpu.live_objects().into_iter().collect::<Vec<_>>(),
        [],
        "what is left"
    );
}

/// Bytes of memory that this process has in use, and how many files it has open.
#[cfg(target_os = "linux")]
fn footprint() -> (i64, usize) {
    let pages = std::fs::read_to_string("/proc/self/statm").expect("Linux says it");
    let resident = pages.split(' ').nth(1).and_then(|n| n.parse::<i64>().ok());
    let files = std::fs::read_dir("/proc/self/fd").expect("Linux says it");
    (4096 * resident.expect("a number"), files.count())
}

/// Elsewhere nobody asks.
#[cfg(not(target_os = "linux"))]
fn footprint() -> (i64, usize) {
    println!("skipped: the memory of this process is not known");
    (0, 0)
}

/// Loops of a run: 10 000 where somebody has the minutes, `STRATAVOX_LOOPS=10000`.
fn loops() -> u32 {
    let wanted = std::env::var("STRATAVOX_LOOPS").ok();
    wanted.map_or(75, |n| n.parse().expect("a number of loops"))
}

/// What grows with the number of pictures, and not with the first ones.
#[track_caller]
fn assert_no_growth(mut draw: impl FnMut()) {
    const WARM_UP: u32 = 25;
    (0..WARM_UP).for_each(|_| draw());
    let (before, files_before) = footprint();
    (0..loops()).for_each(|_| draw());
    let (after, files_after) = footprint();
    let growth = after - before;
    println!(
        "{} loops: {growth} bytes more, {files_after} files",
        loops()
    );
    assert_eq!(files_after, files_before, "open files");
    assert!(growth < 1 << 20, "{growth} bytes more");
}

#[test]
fn a_host_that_makes_draws_and_drops_again_and_again_takes_no_more_memory() {
    let tape = Tape::begin();
    let (host, stage) = (Host::new(), Stage::new());
    let device = host.device(Features {
        dynamic_rendering: true,
        synchronization2: true,
        ..Features::default()
    });
    let mut first = None;
    assert_no_growth(|| {
        // SAFETY: the handles are right, and everything made on the device is dropped before it.
        let gpu = unsafe { Gpu::from_host(device.handles(hooked)).unwrap() };
        let drawn = stage.draw(&device, &gpu).unwrap();
        drop(gpu);
        assert_eq!(tape.books(), Vec::<&str>::new());
        assert!(
            *first.get_or_insert_with(|| drawn.clone()) == drawn,
            "another picture"
        );
    });
}

#[test]
fn renderers_one_after_the_other_on_one_device_take_no_more_memory() {
    let stage = Stage::new();
    let settings = Settings {
        technique: Technique::Slices3d,
        ..Settings::default()
    };
    let scene = Scene {
        beside: Default::default(),
        volume: &stage.volume,
        transfer: Some(&stage.transfer),
        camera: &stage.camera,
        extent_pixels: [16, 12],
        settings: &settings,
    };
    let mut device = Some(device());
    assert_no_growth(|| {
        let free = device.take().expect("given back");
        let mut renderer = Renderer::new(free, &stage.volume).unwrap();
        renderer.render(&scene, &[]).unwrap();
        device = Some(renderer.into_device());
    });
}
