//! Two frames of one renderer are unfinished at once, with other cameras and other transfer functions: each shows what
//! it shows alone.

use crate::embed_shared::{Host, HostImage, Pace, Stage};
use ash::vk;
use glam::DMat3;
use std::sync::Arc;
use stratavox::embed::{FrameInfo, Renderer, RendererDesc, Volume};
use stratavox::gpu::Load;
use stratavox::technique::{Mode, Settings, Technique};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const IN_FLIGHT: u64 = 2;
const FRAMES: u64 = 6;

/// The stage as frame `n` shows it: the eye goes around, the function is dragged.
fn turned(settings: &Settings, n: u64) -> Stage {
    let mut stage = Stage::new(settings.clone());
    stage.settings.conformance = false;
    let around = DMat3::from_rotation_z(0.4 * n as f64);
    let target = stage.camera.target;
    stage.camera.eye = target + around * (stage.camera.eye - target);
    for point in &mut stage.transfer.opacity {
        point.value *= 1.0 - 0.07 * n as f64;
    }
    stage
}

fn renderer(host: &Host, volume: &Arc<Volume>, stage: &Stage, frames: u64) -> Renderer {
    let class = RendererDesc {
        settings: stage.settings.clone(),
        target: FORMAT.into(),
        frames_in_flight: frames as u32,
        host_depth: false,
        // The depth of slices has images and parameters of its own for each frame.
        gives_depth: false,
        picks: true,
        slice_blending: Default::default(),
    };
    let function = Some(&stage.transfer);
    Renderer::new(host.gpu(), volume, function, class, stage.extent, &[]).unwrap()
}

/// Records a frame into the host's image, and its way back.
fn record(
    cmd: vk::CommandBuffer,
    renderer: &mut Renderer,
    stage: &Stage,
    image: &HostImage,
    frame: u32,
) {
    let shot = FrameInfo {
        frame,
        camera: &stage.camera,
        depth: None,
    };
    let target = image.target();
    // SAFETY: outside rendering; the frame that last had this number is done, and all of it lives until this one is.
    unsafe {
        let load = Load::Clear([0.0; 4]);
        renderer.record_into(cmd, &shot, &target, load).unwrap();
        renderer.record_pick(cmd, frame, [20, 17]).unwrap();
        image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
    }
}

#[test]
fn two_frames_in_flight_show_what_each_shows_alone() {
    for (technique, mode) in [
        (Technique::Raycast, Mode::Composite),
        (Technique::Raycast, Mode::Mip),
        (Technique::Slices3d, Mode::Composite),
        (Technique::Slices2d, Mode::Mip),
    ] {
        let host = Host::with_timeline();
        let gpu = host.gpu();
        let settings = Settings {
            technique,
            mode,
            ..Settings::default()
        };
        let first = turned(&settings, 0);
        let mut volume = Volume::new(gpu, &first.volume, &first.settings).unwrap();
        // SAFETY: outside rendering; `run` waits.
        host.run(|cmd| unsafe { volume.record_upload(gpu, cmd).unwrap() });
        let volume = Arc::new(volume);
        let alone = |n: u64| {
            let stage = turned(&settings, n);
            let mut renderer = renderer(&host, &volume, &stage, 1);
            let image = HostImage::new(&host, FORMAT, stage.extent);
            host.run(|cmd| record(cmd, &mut renderer, &stage, &image, 0));
            (image.numbers(), renderer.pick(0, [20, 17]).unwrap())
        };
        let wanted: Vec<_> = (0..=FRAMES).map(alone).collect();
        assert!(wanted.windows(2).all(|pair| pair[0].0 != pair[1].0));
        let mut renderer = renderer(&host, &volume, &first, IN_FLIGHT);
        let frames = [0, 1].map(|_| {
            let image = HostImage::new(&host, FORMAT, first.extent);
            (image, host.command_buffer())
        });
        let pace = Pace::new(&host);
        let finish = |renderer: &Renderer, n: u64| {
            pace.wait(n);
            let slot = n % IN_FLIGHT;
            let found = frames[slot as usize].0.numbers();
            assert!(
                found == wanted[n as usize].0,
                "{technique} {mode}: frame {n}"
            );
            // SAFETY: the timeline has just said so.
            unsafe { gpu.retire(n) };
            let picked = renderer.pick(slot as u32, [20, 17]).unwrap();
            assert_eq!(
                picked, wanted[n as usize].1,
                "{technique} {mode}: frame {n}"
            );
        };
        for n in 1..=FRAMES {
            if n > IN_FLIGHT {
                finish(&renderer, n - IN_FLIGHT);
            }
            let stage = turned(&settings, n);
            let (image, cmd) = &frames[(n % IN_FLIGHT) as usize];
            gpu.announce(n);
            renderer.set_function(Some(&stage.transfer)).unwrap();
            host.record(*cmd, |cmd| {
                record(cmd, &mut renderer, &stage, image, (n % IN_FLIGHT) as u32)
            });
            pace.submit(*cmd, n);
            // Frame n - 1 could not begin while this one was recorded.
            assert_eq!(pace.done(), n.saturating_sub(IN_FLIGHT));
            if n > 1 {
                pace.open(n - 1);
            }
        }
        pace.open(FRAMES);
        finish(&renderer, FRAMES - 1);
        finish(&renderer, FRAMES);
    }
}
