//! What a renderer makes on a device goes with it, however often.

mod hooked;
mod shared;

use hooked::{Host, Stage, Tape, hooked};
use shared::{device, oblique_camera, projections, ramps, sheared_affine, volume_of, waves};
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicI64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use stratavox::gpu::{Features, Gpu};
use stratavox::offscreen::Renderer;
use stratavox::picture::LayerKind;
use stratavox::scene::Scene;
use stratavox::technique::{Mode, Settings, Technique};

#[test]
fn a_dropped_renderer_leaves_no_vulkan_object() {
    let _one = one_at_a_time();
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

/// Counts the bytes that Rust has on the heap: ours, to the byte, and nothing of the driver's.
struct Counted;

static HEAP_BYTES: AtomicI64 = AtomicI64::new(0);

#[global_allocator]
static COUNTED: Counted = Counted;

// SAFETY: all is handed on to the system's allocator.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        HEAP_BYTES.fetch_add(layout.size() as i64, Ordering::Relaxed);
        // SAFETY: the caller's promise, here and below.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        HEAP_BYTES.fetch_sub(layout.size() as i64, Ordering::Relaxed);
        // SAFETY: as above.
        unsafe { System.dealloc(at, layout) }
    }
}

/// Bytes of memory that this process has in use, the driver's with them, and how many files it has open.
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

/// Loops of a run: `STRATAVOX_LOOPS=10000` where somebody has the minutes.
fn loops() -> u32 {
    let wanted = std::env::var("STRATAVOX_LOOPS").ok();
    wanted.map_or(75, |n| n.parse().expect("a number of loops"))
}

/// What is lost in each loop is missed in each quarter of the loops; a map with holes becomes larger once, at a time of
/// its own. So the quarter in which our heap grew most is left out, and the others together grow by no more than the
/// slack: 24 bytes a loop would be 1296 in three quarters. As many files are open as before. The process as a whole, in
/// which the driver's threads make heaps of their own when they first meet, grows by whole MiB in some quarter or
/// other: in the two in which it grew least, by less than 1 MiB together.
#[track_caller]
fn assert_no_growth(slack_bytes: i64, mut draw: impl FnMut()) {
    (0..25).for_each(|_| draw());
    let heap = HEAP_BYTES.load(Ordering::Relaxed);
    let (mut before, files) = footprint();
    // Printed at the end: what a test prints is kept on our heap.
    let mut quarters = [(0, 0, 0); 4];
    for quarter in &mut quarters {
        (0..loops() / 4).for_each(|_| draw());
        let ours = HEAP_BYTES.load(Ordering::Relaxed) - heap;
        let (now, files_now) = footprint();
        *quarter = (ours, now - before, files_now);
        before = now;
    }
    println!("{} loops, by quarters: {quarters:?}", loops());
    let mut had = 0;
    let mut grown = quarters.map(|(ours, _, _)| ours - std::mem::replace(&mut had, ours));
    grown.sort_unstable();
    let steady: i64 = grown[..3].iter().sum();
    assert!(
        steady <= slack_bytes && (slack_bytes > 0 || grown[3] < 1024),
        "our heap grows by {steady} bytes beside its largest step: {quarters:?}"
    );
    assert!(
        quarters.iter().all(|(_, _, open)| *open == files),
        "of {files} open files: {quarters:?}"
    );
    let mut of_process = quarters.map(|(_, grown, _)| grown);
    of_process.sort_unstable();
    let steady = of_process[0].max(0) + of_process[1];
    assert!(steady < 1 << 20, "{steady} bytes more: {quarters:?}");
}

/// The heap is that of the whole process.
fn one_at_a_time() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}

#[test]
fn a_host_that_makes_draws_and_drops_again_and_again_takes_no_more_memory() {
    let _one = one_at_a_time();
    let tape = Tape::begin();
    let (host, stage) = (Host::new(), Stage::new());
    let device = host.device(Features {
        dynamic_rendering: true,
        synchronization2: true,
        ..Features::default()
    });
    let mut first = None;
    assert_no_growth(0, || {
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
    let _one = one_at_a_time();
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
    // Maps have seeds of their own, and make room at other times: one object of 24 bytes a loop is more than that.
    assert_no_growth(1024, || {
        let free = device.take().expect("given back");
        let mut renderer = Renderer::new(free, &stage.volume).unwrap();
        renderer.render(&scene, &[]).unwrap();
        device = Some(renderer.into_device());
    });
}

#[test]
fn renderers_of_a_host_one_after_the_other_take_no_more_memory() {
    let _one = one_at_a_time();
    let tape = Tape::begin();
    let (host, mut stage) = (Host::new(), Stage::new());
    let device = host.device(Features {
        dynamic_rendering: true,
        synchronization2: true,
        timeline_semaphore: true,
        ..Features::default()
    });
    // SAFETY: the handles are right, and everything made on the device is dropped before it.
    let gpu = unsafe { Gpu::from_host(device.handles(hooked)).unwrap() };
    // By rays and by slices in turn.
    let mut pictures = [None, None];
    // Maps have seeds of their own, as above.
    assert_no_growth(1024, || {
        for (technique, first) in [Technique::Raycast, Technique::Slices3d]
            .into_iter()
            .zip(&mut pictures)
        {
            stage.settings.technique = technique;
            let drawn = stage.submit(&device, &gpu).unwrap();
            // SAFETY: it has waited for its timeline.
            unsafe { gpu.retire(u64::MAX) };
            assert!(
                *first.get_or_insert_with(|| drawn.clone()) == drawn,
                "another picture"
            );
        }
    });
    drop(gpu);
    assert_eq!(tape.books(), Vec::<&str>::new());
}
