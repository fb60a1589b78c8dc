//! Stopping between two submissions, and being told how far a picture is.

use super::{EXTENT, bits, small};
use crate::shared::{device, oblique_camera, projections, ramps};
use std::sync::Arc;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use stratavox::gpu;
use stratavox::offscreen::{Error, Renderer};
use stratavox::scene::Scene;
use stratavox::technique::{Settings, Technique};

#[test]
fn a_picture_that_is_stopped_in_the_middle_is_an_error_and_the_next_one_is_whole() {
    let volume = small();
    let grid = volume.grid();
    let (camera, function) = (oblique_camera(&grid, projections(&grid)[0]), ramps());
    for technique in [Technique::Raycast, Technique::Slices3d] {
        let settings = Settings {
            technique,
            // Patches are drawn by slices, not by tiles.
            skip: technique == Technique::Raycast,
            ..Settings::default()
        };
        let scene = Scene {
            beside: Default::default(),
            volume: &volume,
            transfer: Some(&function),
            camera: &camera,
            extent_pixels: EXTENT,
            settings: &settings,
        };
        let mut renderer = Renderer::new(device(), &volume).unwrap();
        let wanted = renderer.render(&scene, &[]).unwrap().picture;

        let stop = Arc::new(AtomicBool::new(false));
        let at_half = Arc::clone(&stop);
        renderer.stop_when(Arc::clone(&stop));
        renderer.watch(move |part| at_half.store(part >= 0.5, Ordering::Relaxed));
        renderer.set_submission_ms(0.0);
        let before = renderer.device().submissions().count;
        let stopped = renderer.render(&scene, &[]).unwrap_err();
        assert!(
            matches!(stopped, Error::Gpu(gpu::Error::Stopped)),
            "{stopped}"
        );
        // Six of twelve workgroups, and not one more.
        assert_eq!(renderer.device().submissions().count - before, 6);
        assert!(renderer.upload(&scene).is_ok(), "all is there already");

        stop.store(false, Ordering::Relaxed);
        renderer.watch(|_| ());
        let found = renderer.render(&scene, &[]).unwrap().picture;
        assert!(bits(&found) == bits(&wanted), "{technique:?}");
    }
}

#[test]
fn nothing_is_begun_once_it_is_to_stop_and_no_half_made_volume_stays() {
    let volume = small();
    let grid = volume.grid();
    let (camera, function) = (oblique_camera(&grid, projections(&grid)[0]), ramps());
    let settings = Settings::default();
    let scene = Scene {
        beside: Default::default(),
        volume: &volume,
        transfer: Some(&function),
        camera: &camera,
        extent_pixels: EXTENT,
        settings: &settings,
    };
    let wanted = Renderer::new(device(), &volume).unwrap();
    let wanted = { wanted }.render(&scene, &[]).unwrap().picture;
    let stop = Arc::new(AtomicBool::new(true));
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    renderer.stop_when(Arc::clone(&stop));
    for _ in 0..2 {
        let stopped = renderer.render(&scene, &[]).unwrap_err();
        assert!(matches!(stopped, Error::Gpu(gpu::Error::Stopped)));
        assert_eq!(renderer.device().submissions().count, 0);
    }
    stop.store(false, Ordering::Relaxed);
    let found = renderer.render(&scene, &[]).unwrap().picture;
    assert!(bits(&found) == bits(&wanted));
}

#[test]
fn the_watch_is_told_of_growing_parts_up_to_the_whole_of_all_rays_of_a_pixel() {
    let volume = small();
    let grid = volume.grid();
    let (camera, function) = (oblique_camera(&grid, projections(&grid)[0]), ramps());
    let settings = Settings {
        rays_per_side: 2,
        ..Settings::default()
    };
    let scene = Scene {
        beside: Default::default(),
        volume: &volume,
        transfer: Some(&function),
        camera: &camera,
        extent_pixels: EXTENT,
        settings: &settings,
    };
    let told = Arc::new(Mutex::new(Vec::new()));
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let telling = Arc::clone(&told);
    renderer.watch(move |part| telling.lock().unwrap().push(part));
    renderer.set_submission_ms(0.0);
    for _ in 0..2 {
        renderer.render(&scene, &[]).unwrap();
        let told = std::mem::take(&mut *told.lock().unwrap());
        // Four rays of each of twelve workgroups.
        assert_eq!(told.len(), 48);
        for (n, part) in (1..).zip(told) {
            let wanted = f64::from(n) / 48.0;
            assert!((part - wanted).abs() < 1e-12, "{n}: {part}");
        }
    }
}
