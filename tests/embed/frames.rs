//! A host with a timeline keeps two frames in flight, and drops what the device still uses.

use crate::embed_shared::{Host, HostImage, OnDevice, Pace, Stage, assert_close, over};
use ash::vk;
use glam::DMat3;
use stratavox::gpu::{Bindings, Blend, Image, ParameterRing, Use, image_barrier};
use stratavox::resolve::Resolve;
use stratavox::technique::raycast::Raycast;
use stratavox::technique::{
    Inputs, Mode, RayBindings, RayTiles, Settings, ShaderVariant, accumulation, parameter_ring,
};

const FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;
const DRAWN: [f32; 4] = [0.25, 0.0, 0.5, 1.0];
const IN_FLIGHT: usize = 2;

/// What a host makes before its first frame.
struct Ready<'h> {
    there: OnDevice,
    ring: ParameterRing,
    raycast: Raycast,
    resolve: Resolve,
    frames: Vec<InFlight<'h>>,
}

/// What only one frame in flight may use at a time.
struct InFlight<'h> {
    cmd: vk::CommandBuffer,
    image: HostImage<'h>,
    gathered: Image,
    layers: Image,
    bound: RayBindings,
    resolved: Bindings,
}

impl<'h> Ready<'h> {
    fn new(host: &'h Host, stage: &Stage) -> Self {
        let gpu = host.gpu();
        let there = OnDevice::new(host, stage);
        let words = ShaderVariant::of(&stage.settings, &there.volume);
        let ring = parameter_ring(gpu, IN_FLIGHT as u32).unwrap();
        let raycast = Raycast::new(gpu, &words).unwrap();
        let resolve = Resolve::new(gpu, Mode::Composite, Blend::Over, FORMAT).unwrap();
        let inputs = Inputs {
            beside: &[],
            light: None,
            points: None,
            field: None,
            sky: None,
            skip: stratavox::technique::Skip::Nothing,
            ring: &ring,
            volume: &there.volume,
            brick: &there.volume.bricks()[0],
            transfer: Some(&there.transfer),
        };
        let in_flight = |_| {
            let gathered = accumulation(gpu, stage.extent, "gathered").unwrap();
            let layers = accumulation(gpu, stage.extent, "layers").unwrap();
            let tiles = RayTiles::new(gpu, stage.extent).unwrap();
            InFlight {
                cmd: host.command_buffer(),
                image: HostImage::new(host, FORMAT, stage.extent),
                bound: raycast.bind(&inputs, &gathered, &layers, &tiles).unwrap(),
                resolved: resolve.bind(&ring, &gathered, None).unwrap(),
                gathered,
                layers,
            }
        };
        let frames = (0..IN_FLIGHT).map(in_flight).collect();
        Self {
            there,
            ring,
            raycast,
            resolve,
            frames,
        }
    }

    /// Parameters into the frame's own slot, commands into its own command buffer; nothing is made.
    fn record(&self, host: &Host, stage: &Stage, slot: usize) {
        let gpu = host.gpu();
        let made = || {
            (
                gpu.live_objects(),
                gpu.pipelines_made(),
                gpu.memory().reserved_bytes,
            )
        };
        let before = made();
        let OnDevice { volume, transfer } = &self.there;
        let recordings = stage.view().recordings(volume, Some(transfer)).unwrap();
        let offset = recordings[0].write(&self.ring, slot as u32).unwrap();
        let frame = &self.frames[slot];
        // SAFETY: barriers stand between the passes; the frame that last used all this is finished.
        host.record(frame.cmd, |cmd| unsafe {
            for written in [&frame.gathered, &frame.layers] {
                image_barrier(gpu, cmd, written, Use::Nothing, Use::ComputeWrite);
            }
            let extent = stage.extent;
            self.raycast
                .record(cmd, &frame.bound, offset, extent)
                .unwrap();
            image_barrier(
                gpu,
                cmd,
                &frame.gathered,
                Use::ComputeWrite,
                Use::FragmentSampled,
            );
            frame.image.make_target(cmd);
            host.begin_rendering(cmd, frame.image.view, extent, DRAWN);
            self.resolve.record(cmd, &frame.resolved, offset, extent);
            host.device.cmd_end_rendering(cmd);
            frame.image.fetch_drawn(cmd);
        });
        assert_eq!(made(), before, "recording made or destroyed something");
    }

    /// Submits frame `n` from its slot.
    fn submit(&self, slot: usize, n: u64, pace: &Pace) {
        pace.submit(self.frames[slot].cmd, n);
    }
}

/// The stage as frame `n` sees it: the eye goes around.
fn turned(n: u64) -> Stage {
    let mut stage = Stage::new(Settings::default());
    let around = DMat3::from_rotation_z(0.4 * n as f64);
    let target = stage.camera.target;
    stage.camera.eye = target + around * (stage.camera.eye - target);
    stage
}

fn assert_shows(image: &HostImage, stage: &Stage, what: &str) {
    let wanted: Vec<_> = stage.reference().iter().map(|&p| over(p, DRAWN)).collect();
    assert_close(image, &wanted, 1, what);
}

#[test]
fn the_next_frame_is_written_and_recorded_while_the_last_one_waits() {
    const FRAMES: u64 = 6;
    let host = Host::with_timeline();
    let ready = Ready::new(&host, &turned(0));
    let pace = Pace::new(&host);
    let finish = |n: u64| {
        pace.wait(n);
        let image = &ready.frames[n as usize % IN_FLIGHT].image;
        assert_shows(image, &turned(n), &format!("frame {n}"));
        // SAFETY: the timeline has just said so.
        unsafe { host.gpu().retire(n) };
    };
    for n in 1..=FRAMES {
        let slot = n as usize % IN_FLIGHT;
        if n > IN_FLIGHT as u64 {
            finish(n - IN_FLIGHT as u64);
        }
        host.gpu().announce(n);
        ready.record(&host, &turned(n), slot);
        ready.submit(slot, n, &pace);
        // Frame n - 1 could not begin while this one was written.
        assert_eq!(pace.done(), n.saturating_sub(IN_FLIGHT as u64));
        if n > 1 {
            pace.open(n - 1);
        }
    }
    pace.open(FRAMES);
    finish(FRAMES - 1);
    finish(FRAMES);
}

#[test]
fn what_is_dropped_in_use_lives_until_its_frame_is_done() {
    let host = Host::with_timeline();
    let stage = turned(1);
    let mut ready = Ready::new(&host, &stage);
    let pace = Pace::new(&host);
    let gpu = host.gpu();
    // SAFETY: the upload was waited for.
    unsafe { gpu.retire(0) };
    let used = gpu.live_objects();
    gpu.announce(1);
    ready.record(&host, &stage, 0);
    ready.submit(0, 1, &pace);
    // The host's own images stay; all that is ours goes.
    let images: Vec<_> = ready.frames.drain(..).map(|frame| frame.image).collect();
    drop(ready);
    // SAFETY: nothing of frame 1 is said to be done.
    unsafe { gpu.retire(0) };
    assert_eq!(
        gpu.live_objects(),
        used,
        "destroyed while the device used it"
    );
    pace.open(1);
    pace.wait(1);
    assert_shows(&images[0], &stage, "the frame of what was dropped");
    // SAFETY: the timeline has just said so.
    unsafe { gpu.retire(1) };
    let left = gpu.live_objects();
    assert!(left.is_empty(), "never destroyed: {left:?}");
}
