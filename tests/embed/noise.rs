//! The noise of paths in a host's frames is what offscreen pictures say of as many, told by the frame that had the same number
//! before; and nothing is known of a picture that has begun anew.

use crate::driver_faults::{NOISE_FAULTS, alone, faulty, tell, told};
use crate::embed_shared::{Host, HostImage, Stage};
use crate::paths::{FORMAT, frames, path, renderer, stage};
use crate::shared::device;
use stratavox::embed::{FrameInfo, Renderer};
use stratavox::gpu::Load;
use stratavox::offscreen;
use stratavox::scene::Scene;
use stratavox::technique::pathtrace::PathTracing;

/// Paths, in blocks of two, as offscreen the first eight are.
const PATHS: u32 = 8;

/// What offscreen pictures say of so many paths.
fn told_offscreen(stage: &Stage, paths: u32) -> f64 {
    let mut settings = stage.settings.clone();
    settings.path.samples = paths;
    let scene = Scene {
        volume: &stage.volume,
        transfer: Some(&stage.transfer),
        beside: Default::default(),
        camera: &stage.camera,
        extent_pixels: stage.extent,
        settings: &settings,
    };
    let mut renderer = offscreen::Renderer::new(device(), &stage.volume).unwrap();
    renderer.render(&scene, &[]).unwrap();
    renderer.traced().noise.expect("several blocks")
}

/// f32 rounds the luminances of a mean before a frame and with it to 4 e of themselves each, e = 2^-24. Of the last of B blocks of n
/// paths they count b (b + n) / n <= B^2 n times, and there are B of them: a deviation is off as if its root were by
/// 8 e B sqrt(B n) y, and the noise, whose root has N (B - 1) = n B (B - 1) under it, by 8 e B. Sums of 16 numbers, in pairs of 64, of
/// the tiles, and in pairs again, of which none is negative, are off by 30 e of themselves.
fn rounded(noise: f64, blocks: u32) -> f64 {
    let e = 0.5f64.powi(24);
    8.0 * e * f64::from(blocks) + 30.0 * e * noise
}

fn of_paths(samples: u32) -> Stage {
    stage(PathTracing {
        samples,
        samples_per_frame: 2,
        ..path()
    })
}

/// What is off of the noise of so many paths, in words.
fn off(renderer: &Renderer, wanted: f64, paths: u32) -> Result<(), String> {
    let found = renderer.noise().ok_or("nothing is known")?;
    println!("{paths} paths: {found}, offscreen {wanted}");
    match (found - wanted).abs() <= rounded(wanted, paths / 2) {
        true => Ok(()),
        false => Err(format!("{found} of {paths} paths for {wanted}")),
    }
}

#[track_caller]
fn assert_is(renderer: &Renderer, stage: &Stage, paths: u32) {
    assert_eq!(off(renderer, told_offscreen(stage, paths), paths), Ok(()));
}

#[test]
fn each_fault_of_noise_is_seen() {
    let stage = of_paths(PATHS);
    let wanted = told_offscreen(&stage, PATHS);
    let _alone = alone();
    for (what, fault) in NOISE_FAULTS {
        tell(Some(*fault));
        // SAFETY: its functions are Vulkan's, but for shaders that are others.
        let host = unsafe { Host::through(faulty) };
        let mut renderer = renderer(&host, &stage);
        frames(&host, &mut renderer, &stage.camera, 4);
        frames(&host, &mut renderer, &stage.camera, 2);
        let found = off(&renderer, wanted, PATHS);
        assert!(told() > 0, "{what}: no shader has it");
        tell(None);
        println!("{what}: {}", found.expect_err(what));
    }
}

#[test]
fn noise_is_what_offscreen_pictures_say_two_frames_later() {
    let host = Host::new();
    let stage = of_paths(PATHS);
    let mut renderer = renderer(&host, &stage);
    assert_eq!(renderer.noise(), None);
    // Two frames in flight: nothing comes round before the third, and one block tells nothing.
    frames(&host, &mut renderer, &stage.camera, 2);
    assert_eq!(renderer.noise(), None);
    // Frames 2 and 3: the second one finds what frame 1 has told.
    frames(&host, &mut renderer, &stage.camera, 2);
    assert_eq!(renderer.paths_traced(), PATHS);
    assert_is(&renderer, &stage, 4);
    // None is traced any more.
    frames(&host, &mut renderer, &stage.camera, 1);
    assert_is(&renderer, &stage, 6);
    frames(&host, &mut renderer, &stage.camera, 2);
    assert_is(&renderer, &stage, PATHS);
    frames(&host, &mut renderer, &stage.camera, 2);
    assert_is(&renderer, &stage, PATHS);
}

#[test]
fn nothing_is_known_of_a_picture_that_begins_anew() {
    let host = Host::new();
    let mut stage = of_paths(64);
    let mut renderer = renderer(&host, &stage);
    let known = |renderer: &mut Renderer, stage: &Stage, what: &str| {
        frames(&host, renderer, &stage.camera, 4);
        assert!(renderer.noise().is_some(), "{what}");
    };
    known(&mut renderer, &stage, "at first");
    renderer.restart_paths();
    assert_eq!(renderer.noise(), None, "restarted");
    frames(&host, &mut renderer, &stage.camera, 2);
    assert_eq!(
        renderer.noise(),
        None,
        "frames before the restart tell nothing"
    );
    known(&mut renderer, &stage, "restarted");
    stage.camera.zoom *= 1.1;
    frames(&host, &mut renderer, &stage.camera, 2);
    assert_eq!(renderer.noise(), None, "another camera");
    known(&mut renderer, &stage, "another camera");
    stage.settings.tone.exposure = 1.0;
    renderer.set_settings(stage.settings.clone()).unwrap();
    assert!(
        renderer.noise().is_some(),
        "another tone is no other picture"
    );
    stage.settings.path.seed += 1;
    renderer.set_settings(stage.settings.clone()).unwrap();
    assert_eq!(renderer.noise(), None, "another seed");
    known(&mut renderer, &stage, "another seed");
    renderer.set_function(Some(&stage.transfer)).unwrap();
    assert_eq!(renderer.noise(), None, "another function");
    known(&mut renderer, &stage, "another function");
    renderer.resize([23, 40], &[]).unwrap();
    assert_eq!(renderer.noise(), None, "another size");
    known(&mut renderer, &stage, "another size");
}

/// A frame that is recorded and never runs tells nothing, and neither does one in parts that is given up.
#[test]
fn frames_that_do_not_run_tell_nothing() {
    let host = Host::new();
    let stage = of_paths(64);
    let mut renderer = renderer(&host, &stage);
    frames(&host, &mut renderer, &stage.camera, 4);
    let known = renderer.noise();
    let image = HostImage::new(&host, FORMAT, stage.extent);
    let shot = |frame| FrameInfo {
        frame,
        camera: &stage.camera,
        depth: None,
    };
    let load = Load::Clear([0.0; 4]);
    let lost = host.command_buffer();
    host.record(lost, |cmd| {
        // SAFETY: nothing of this runs.
        unsafe { renderer.record_into(cmd, &shot(0), &image.target(), load) }.unwrap();
    });
    let before = renderer.noise();
    assert!(before != known, "frame 2 has told of 6 paths");
    host.record(lost, |cmd| {
        // SAFETY: as above.
        unsafe { renderer.record_into(cmd, &shot(0), &image.target(), load) }.unwrap();
    });
    assert_eq!(renderer.noise(), before, "what was lost has told nothing");
    assert!(renderer.begin_parts(&shot(1)).unwrap() > 1);
    host.run(|cmd| {
        // SAFETY: one part of several; `run` waits.
        unsafe { renderer.record_part_into(cmd, 1, 1, &image.target(), load) }.unwrap();
    });
    assert_eq!(renderer.noise(), None, "half a frame");
}

#[test]
fn what_traces_no_paths_has_no_noise() {
    let host = Host::new();
    let stage = Stage::new(Default::default());
    let mut renderer = renderer(&host, &stage);
    frames(&host, &mut renderer, &stage.camera, 4);
    assert_eq!(renderer.noise(), None);
}
