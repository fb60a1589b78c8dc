//! A volume ends at a tube that the device has drawn as it does at the same tube offscreen.

use super::drawn;
use crate::embed_shared::{ATTACHED, Eye, Host, HostImage, READ, Stage, eyes};
use ash::vk;
use std::sync::Arc;
use stratavox::camera::Camera;
use stratavox::embed::{FrameInfo, HostDepthImage, Renderer, RendererDesc, Volume};
use stratavox::geometry::{Geometry, RoundCones, Vertex};
use stratavox::offscreen;
use stratavox::scene::Scene;
use stratavox::technique::Settings;

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// As `tests/embed/depth.rs` has it for the ends of rays that move by what a depth buffer rounds.
const ALLOWED: f64 = 1e-4;

/// From behind the volume through its middle to before it.
fn tube(stage: &Stage) -> RoundCones {
    let center = stage.grid.center();
    let away = (center - stage.camera.eye).normalize();
    let aside = away.cross(glam::DVec3::Z).normalize();
    let at = |part: f64| Vertex {
        place: center + 14.0 * part * (away + 0.6 * aside),
        radius: 2.0 + part,
        color: [0.8, 0.5, 0.2],
    };
    let mut cones = RoundCones::default();
    cones.add_line([-1.0, -0.3, 0.4, 1.0].map(at));
    cones
}

fn embedded(host: &Host, stage: &Stage, eye: &Eye, shapes: &Geometry) -> Vec<[f64; 4]> {
    let (camera, depth) = Camera::from_matrices(&eye.view, &eye.clip, eye.nearer).unwrap();
    let behind = drawn(host, shapes, (&camera, &depth), stage.extent);
    let mut volume = Volume::new(host.gpu(), &stage.volume, &stage.settings).unwrap();
    // SAFETY: outside rendering; `run` waits.
    host.run(|cmd| unsafe { volume.record_upload(host.gpu(), cmd).unwrap() });
    let class = RendererDesc {
        settings: stage.settings.clone(),
        target: FORMAT.into(),
        frames_in_flight: 1,
        host_depth: true,
        gives_depth: false,
        picks: false,
        slice_blending: Default::default(),
    };
    // SAFETY: the buffer outlives the renderer.
    let read = [unsafe { HostDepthImage::new(behind.buffer.view, READ.2, stage.extent) }];
    let (volume, function) = (Arc::new(volume), Some(&stage.transfer));
    let mut renderer =
        Renderer::new(host.gpu(), &volume, function, class, stage.extent, &read).unwrap();
    let image = HostImage::new(host, FORMAT, stage.extent);
    let shot = FrameInfo {
        frame: 0,
        camera: &camera,
        depth: Some(depth),
    };
    // SAFETY: recorded in order; all of it lives until `run` has waited.
    host.run(|cmd| unsafe {
        behind.buffer.barrier(cmd, ATTACHED, READ);
        renderer.record(cmd, &shot).unwrap();
        image.make_target(cmd);
        host.begin_rendering(cmd, image.view, stage.extent, [0.0; 4]);
        renderer.draw(cmd, 0).unwrap();
        host.device.cmd_end_rendering(cmd);
        image.fetch_drawn(cmd);
    });
    let over = |(volume, behind): (&[f64; 4], &[f64; 4])| {
        std::array::from_fn(|c| volume[c] + (1.0 - volume[3]) * behind[c])
    };
    image
        .numbers()
        .iter()
        .zip(&behind.pixels)
        .map(over)
        .collect()
}

#[test]
fn a_volume_ends_at_a_tube_as_in_the_offscreen_picture() {
    let host = Host::new();
    let mut stage = Stage::new(Settings::default());
    stage.extent = [88, 72];
    let shapes = Geometry::from(tube(&stage));
    // Pictures of the program have no near plane, and begin at the eye: so do those whose near plane lies before it all.
    let [first, _, third, _] = eyes(&stage);
    for eye in [first, third] {
        let found = embedded(&host, &stage, &eye, &shapes);
        let (camera, _) = Camera::from_matrices(&eye.view, &eye.clip, eye.nearer).unwrap();
        let scene = Scene {
            volume: &stage.volume,
            transfer: Some(&stage.transfer),
            beside: Default::default(),
            camera: &camera,
            extent_pixels: stage.extent,
            settings: &stage.settings,
        };
        let device = crate::shared::device();
        let mut renderer = offscreen::Renderer::new(device, &stage.volume).unwrap();
        let alone = renderer.render(&scene, &[]).unwrap().picture.pixels;
        renderer.set_geometry(Some(Arc::new(shapes.clone())));
        let wanted = renderer.render(&scene, &[]).unwrap().picture.pixels;
        let (mut others, mut cut, mut worst) = (0, 0, 0.0f64);
        for i in 0..wanted.len() {
            let off = |pixel: &[f64; 4]| {
                let channels = pixel.iter().zip(wanted[i]);
                let off = channels.map(|(found, wanted)| (found - f64::from(wanted)).abs());
                off.fold(0.0, f64::max)
            };
            let off_alone = off(&alone[i].map(f64::from));
            cut += usize::from(off_alone > 0.02 && alone[i][3] > 0.02);
            match off(&found[i]) {
                off if off < ALLOWED => worst = worst.max(off),
                _ => others += 1,
            }
        }
        println!(
            "{}: {cut} pixels cut, {others} other, {worst:.1e}",
            eye.name
        );
        assert!(cut > 200, "{}: {cut} pixels", eye.name);
        // At the outline of the tube.
        assert!(others <= 6, "{}: {others} pixels", eye.name);
    }
}
