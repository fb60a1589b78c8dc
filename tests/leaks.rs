//! What a renderer makes on a device goes with it, however often.
#![cfg(feature = "conformance")]

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

/// Counts what Rust has on the heap: ours, to the byte, and nothing of the driver's.
struct Counted;

static HEAP_BYTES: AtomicI64 = AtomicI64::new(0);
static HEAP_ALLOCATIONS: AtomicI64 = AtomicI64::new(0);

#[global_allocator]
static COUNTED: Counted = Counted;

// SAFETY: all is handed on to the system's allocator.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        HEAP_BYTES.fetch_add(layout.size() as i64, Ordering::Relaxed);
        HEAP_ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's promise, here and below.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        HEAP_BYTES.fetch_sub(layout.size() as i64, Ordering::Relaxed);
        HEAP_ALLOCATIONS.fetch_sub(1, Ordering::Relaxed);
        // SAFETY: as above.
        unsafe { System.dealloc(at, layout) }
    }
}

/// What the process has in use.
#[derive(Clone, Copy, Debug, Default)]
struct Footprint {
    /// On our heap.
    allocations: i64,
    bytes: i64,
    /// Of the process, the driver's with them; 0 where it is not known.
    resident_bytes: i64,
    open_files: usize,
}

impl Footprint {
    fn now() -> Self {
        let (resident_bytes, open_files) = of_process();
        Self {
            allocations: HEAP_ALLOCATIONS.load(Ordering::Relaxed),
            bytes: HEAP_BYTES.load(Ordering::Relaxed),
            resident_bytes,
            open_files,
        }
    }
}

/// Resident bytes and open files. What the C library keeps of freed memory in its arenas, of which each thread of the
/// driver has one, is given back first: it is as large as what was in use at once, and no leak.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn of_process() -> (i64, usize) {
    unsafe extern "C" {
        fn malloc_trim(pad: usize) -> std::ffi::c_int;
    }
    // SAFETY: the function of glibc, which any thread may call.
    unsafe { malloc_trim(0) };
    let pages = std::fs::read_to_string("/proc/self/statm").expect("Linux says it");
    let resident = pages.split(' ').nth(1).and_then(|n| n.parse::<i64>().ok());
    let files = std::fs::read_dir("/proc/self/fd").expect("Linux says it");
    (4096 * resident.expect("a number"), files.count())
}

#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
fn of_process() -> (i64, usize) {
    println!("skipped: the resident memory of this process is not known");
    (0, 0)
}

/// Loops of a run: `STRATAVOX_LOOPS=10000` for `make soak`.
fn loops() -> u32 {
    let wanted = std::env::var("STRATAVOX_LOOPS").ok();
    wanted.map_or(76, |n| n.parse().expect("a number of loops"))
}

/// What maps and vectors that make room may take more, with as many allocations as before. In 10 000 loops an entry of 2
/// bytes a loop is more.
const ROOM_BYTES: i64 = 16 << 10;

/// Maps and vectors of which one moment may find no allocation, and another one each. A leak of one a loop is more in any
/// run.
const ROOM_ALLOCATIONS: i64 = 4;

/// How much the process may grow over all of a run. In 10 000 loops a leak of 210 bytes a loop is more.
const RESIDENT_BYTES: i64 = 2 << 20;

/// Runs that may exceed [`RESIDENT_BYTES`] before the last one: a thread of the driver makes a heap of its own at a time of
/// its choice, once. What each loop loses exceeds it in every run.
const SPARE_RUNS: u32 = 1;

/// Draws so often, and compares the end with the beginning: as many allocations on our heap but for
/// [`ROOM_ALLOCATIONS`], as many bytes but for [`ROOM_BYTES`], as many open files, and no more than [`RESIDENT_BYTES`] of
/// the process, in one of [`SPARE_RUNS`] + 1 runs.
#[track_caller]
fn assert_no_growth(mut draw: impl FnMut()) {
    (0..25).for_each(|_| draw());
    for spare in (0..=SPARE_RUNS).rev() {
        // What is printed is kept on our heap: at the end.
        let mut seen = [Footprint::now(); 5];
        for quarter in &mut seen[1..] {
            (0..loops() / 4).for_each(|_| draw());
            *quarter = Footprint::now();
        }
        let [before, .., after] = seen;
        print_growth(&seen);
        assert!(
            after.allocations - before.allocations <= ROOM_ALLOCATIONS,
            "allocations: {seen:#?}"
        );
        assert!(after.bytes - before.bytes <= ROOM_BYTES, "heap: {seen:#?}");
        assert_eq!(after.open_files, before.open_files, "files: {seen:#?}");
        let grown = after.resident_bytes - before.resident_bytes;
        if grown <= RESIDENT_BYTES {
            return;
        }
        assert!(spare > 0, "{grown} bytes more: {seen:#?}");
    }
}

fn print_growth(seen: &[Footprint; 5]) {
    let [before, .., after] = seen;
    let kib = |bytes: i64| bytes / 1024;
    let grown = seen.windows(2);
    let grown = grown.map(|pair| pair[1].resident_bytes - pair[0].resident_bytes);
    println!(
        "{} loops: {} to {} KiB resident, by {} in the quarter with most; {} to {} allocations and {} to {} bytes on our \
         heap; {} to {} open files",
        loops() / 4 * 4,
        kib(before.resident_bytes),
        kib(after.resident_bytes),
        kib(grown.max().unwrap_or_default()),
        before.allocations,
        after.allocations,
        before.bytes,
        after.bytes,
        before.open_files,
        after.open_files,
    );
}

/// The heap is that of the whole process.
fn one_at_a_time() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}

#[test]
fn devices_made_drawn_on_and_destroyed_one_after_the_other_take_no_more_memory() {
    let _one = one_at_a_time();
    let tape = Tape::begin();
    let (host, stage) = (Host::new(), Stage::new());
    let mut first = None;
    assert_no_growth(|| {
        let device = host.device(Features {
            dynamic_rendering: true,
            synchronization2: true,
            ..Features::default()
        });
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
    assert_no_growth(|| {
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
    assert_no_growth(|| {
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
