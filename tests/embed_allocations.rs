//! After the first frame of each frame in flight, levels A and B take nothing from the heap: what a renderer needs to
//! record it has from the day it was made.
#![cfg(feature = "conformance")]

mod embed_shared;
mod shared;

use ash::vk;
use embed_shared::{ATTACHED, DepthImage, Host, HostImage, READ, Stage, all_settings, eyes};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Arc;
use stratavox::camera::{Camera, DepthConvention};
use stratavox::embed::{
    FrameInfo, Geometry, GeometryDesc, HostDepthImage, Renderer, RendererDesc, Volume,
};
use stratavox::geometry;
use stratavox::gpu::{Caps, DepthClass, Load, TargetClass};
use stratavox::technique::{Settings, Technique};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

thread_local! {
    static TAKEN: Cell<u64> = const { Cell::new(0) };
}

/// The system's, counted for each thread: other tests and drivers with threads of their own do not disturb.
struct Counted;

// SAFETY: all is handed on; counting takes nothing from the heap.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // Of a thread that ends nothing is counted any more.
        let _ = TAKEN.try_with(|taken| taken.set(taken.get() + 1));
        // SAFETY: the caller's promises, here and below.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(at, layout) };
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, bytes: usize) -> *mut u8 {
        let _ = TAKEN.try_with(|taken| taken.set(taken.get() + 1));
        // SAFETY: as above.
        unsafe { System.realloc(at, layout, bytes) }
    }
}

#[global_allocator]
static HEAP: Counted = Counted;

/// How often `what` takes something.
fn taken(what: impl FnOnce()) -> u64 {
    let before = TAKEN.get();
    what();
    TAKEN.get() - before
}

/// What [`Geometry::draw`] takes, of cones and of triangles.
#[test]
fn geometry_is_drawn_without_the_heap() {
    let host = Host::new();
    let stage = Stage::new(Settings::default());
    let [eye, ..] = eyes(&stage);
    let (camera, depth) = Camera::from_matrices(&eye.view, &eye.clip, eye.nearer).unwrap();
    let mut shapes = geometry::Geometry::default();
    let place = stage.grid.center();
    shapes
        .cones
        .add_line([-3.0, 0.0, 3.0].map(|x| geometry::Vertex {
            place: place + glam::DVec3::splat(x),
            radius: 1.0,
            color: [0.5; 3],
        }));
    let corner = |x: f64, y: f64| geometry::Corner {
        place: place + glam::dvec3(x, y, 0.0),
        color: [0.5; 3],
    };
    let corners = [corner(0.0, 0.0), corner(5.0, 0.0), corner(0.0, 5.0)];
    shapes.triangles.add(&corners, [[0, 1, 2]]);
    let desc = GeometryDesc {
        target: TargetClass {
            depth: Some(DepthClass {
                format: vk::Format::D32_SFLOAT,
                has_stencil: false,
                is_reversed: depth.nearer == DepthConvention::Reversed,
            }),
            ..FORMAT.into()
        },
        color_space: stage.settings.color_space,
        frames_in_flight: 1,
    };
    let extent = stage.extent;
    let mut made = Geometry::new(host.gpu(), &shapes, desc).unwrap();
    let image = HostImage::new(&host, FORMAT, extent);
    let nothing = vec![1.0; (extent[0] * extent[1]) as usize];
    let buffer = DepthImage::new(&host, extent, &nothing, ATTACHED);
    let shot = FrameInfo {
        frame: 0,
        camera: &camera,
        depth: Some(depth),
    };
    for frame in 0..2 {
        // SAFETY: recorded in order; `run` waits.
        host.run(|cmd| unsafe {
            if frame == 0 {
                made.record_upload(cmd).unwrap();
            }
            image.make_target(cmd);
            host.begin_rendering_before(cmd, image.view, extent, [0.0; 4], Some(&buffer));
            let taken = taken(|| made.draw(cmd, &shot, extent).unwrap());
            assert!(frame == 0 || taken == 0, "{taken} times");
            host.device.cmd_end_rendering(cmd);
        });
    }
}

/// Both frames in flight, and then both again: by level A with depth and picks where the mode has them, and by level B.
fn assert_nothing_is_taken(host: &Host, settings: &Settings) {
    let stage = Stage::new(settings.clone());
    let [eye, ..] = eyes(&stage);
    let (camera, depth) = Camera::from_matrices(&eye.view, &eye.clip, eye.nearer).unwrap();
    let mut volume = Volume::new(host.gpu(), &stage.volume, &stage.settings).unwrap();
    // SAFETY: outside rendering; `run` waits.
    host.run(|cmd| unsafe { volume.record_upload(host.gpu(), cmd).unwrap() });
    let (volume, extent) = (Arc::new(volume), stage.extent);
    // Slices that face neither eye nor light have none, and are behind nothing; nor have pixels that are means of four rays.
    let is_warped = stage.settings.technique == Technique::ShearWarp;
    let is_half = stage.settings.is_half_angle() || is_warped;
    let is_mean = is_half || stage.settings.technique == Technique::Pathtrace;
    let has_depth = stage.settings.mode.has_depth() && !is_mean;
    let inside = RendererDesc {
        settings: stage.settings.clone(),
        target: TargetClass {
            depth: Some(DepthClass {
                format: vk::Format::D32_SFLOAT,
                has_stencil: false,
                is_reversed: depth.nearer == DepthConvention::Reversed,
            }),
            ..FORMAT.into()
        },
        frames_in_flight: 2,
        host_depth: !is_half,
        gives_depth: has_depth,
        picks: false,
        slice_blending: Default::default(),
    };
    let outside = RendererDesc {
        target: FORMAT.into(),
        host_depth: false,
        gives_depth: false,
        picks: false,
        slice_blending: Default::default(),
        ..inside.clone()
    };
    let open = vec![1.0; (extent[0] * extent[1]) as usize];
    let buffer = DepthImage::new(host, extent, &open, READ);
    let reads = inside.reads_host_depth();
    // SAFETY: the buffer outlives the renderers.
    let read = [unsafe { HostDepthImage::new(buffer.view, READ.2, extent) }];
    let read = if reads { &read[..] } else { &[] };
    let function = Some(&stage.transfer);
    let made = |class, read: &[_]| {
        Renderer::new(host.gpu(), &volume, function, class, extent, read).unwrap()
    };
    let (mut inside, mut outside) = (made(inside, read), made(outside, &[]));
    let image = HostImage::new(host, FORMAT, extent);
    let target = image.target();
    for nth in 0..4 {
        let frame = nth % 2;
        let shot = FrameInfo {
            frame,
            camera: &camera,
            depth: Some(depth),
        };
        let told = |call: &str, taken: u64| {
            // The first time a function is uploaded, which may be sorted and packed for it.
            let is_first = nth < 2;
            assert!(is_first || taken == 0, "{call} takes {taken}: {settings:?}");
        };
        // SAFETY: recorded in order; all of it lives until `run` has waited.
        host.run(|cmd| unsafe {
            told("record", taken(|| inside.record(cmd, &shot).unwrap()));
            if has_depth {
                let pick = taken(|| inside.record_pick(cmd, frame, [3, 4]).unwrap());
                told("record_pick", pick);
            }
            image.make_target(cmd);
            buffer.barrier(cmd, READ, ATTACHED);
            host.begin_rendering_before(cmd, image.view, extent, [0.0; 4], Some(&buffer));
            told("draw", taken(|| inside.draw(cmd, frame).unwrap()));
            if has_depth {
                told(
                    "draw_depth",
                    taken(|| inside.draw_depth(cmd, frame).unwrap()),
                );
            }
            host.device.cmd_end_rendering(cmd);
            buffer.barrier(cmd, ATTACHED, READ);
        });
        // SAFETY: as above.
        host.run(|cmd| unsafe {
            let load = Load::Clear([0.0; 4]);
            let into = || outside.record_into(cmd, &shot, &target, load).unwrap();
            told("record_into", taken(into));
        });
        if has_depth {
            let pick = || inside.pick(frame, [3, 4]).map(|_| ()).unwrap();
            told("pick", taken(pick));
        }
    }
}

#[test]
fn a_vector_is_counted() {
    assert_eq!(taken(|| drop(vec![1, 2, 3])), 1);
}

#[test]
fn a_frame_takes_nothing_from_the_heap() {
    let host = Host::new();
    let of_paths = Settings {
        technique: Technique::Pathtrace,
        ..Settings::default()
    };
    for settings in all_settings().into_iter().chain([of_paths]) {
        assert_nothing_is_taken(&host, &settings);
    }
}

#[test]
fn a_frame_of_many_bricks_takes_nothing_from_the_heap() {
    let host = Host::with_caps(Caps {
        max_image_dimension_3d: 12,
        max_image_array_layers: 12,
        ..Caps::UNLIMITED
    });
    // Of each technique one: bricks are gone through in the same way by all modes.
    for technique in [
        Technique::Raycast,
        Technique::Slices3d,
        Technique::Slices2d,
        Technique::ShearWarp,
    ] {
        let settings = Settings {
            technique,
            ..Settings::default()
        };
        assert_nothing_is_taken(&host, &settings);
    }
}
