//! Hosts leave out what cannot be seen of pre-integrated slabs, whose ends reach farther than the filter: the picture
//! is the one of `offscreen::Renderer` that leaves out nothing.

use crate::embed_shared::{Host, HostImage, Stage, offscreen};
use crate::shared::{sheared_affine, volume_of};
use crate::skipping_shared::{DIMS, Numbers, cameras, hills};
use ash::vk;
use glam::{DVec3, dvec3};
use std::sync::Arc;
use stratavox::embed::{FrameInfo, Renderer, RendererDesc, Volume};
use stratavox::gpu::Load;
use stratavox::technique::{Lattice, Settings};
use stratavox::transfer::OpacityPoint;

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

fn drawn(host: &Host, stage: &Stage) -> Vec<[f64; 4]> {
    let mut volume = Volume::new(host.gpu(), &stage.volume, &stage.settings).unwrap();
    // SAFETY: outside rendering; `run` waits.
    host.run(|cmd| unsafe { volume.record_upload(host.gpu(), cmd).unwrap() });
    let class = RendererDesc {
        settings: stage.settings.clone(),
        target: FORMAT.into(),
        frames_in_flight: 1,
        host_depth: false,
        gives_depth: false,
        picks: false,
        slice_blending: Default::default(),
    };
    let function = Some(&stage.transfer);
    let volume = Arc::new(volume);
    let mut renderer =
        Renderer::new(host.gpu(), &volume, function, class, stage.extent, &[]).unwrap();
    let image = HostImage::new(host, FORMAT, stage.extent);
    let shot = FrameInfo {
        frame: 0,
        camera: &stage.camera,
        depth: None,
    };
    // SAFETY: outside rendering; the image is the host's own, and `run` waits.
    host.run(|cmd| unsafe {
        let (target, load) = (image.target(), Load::Clear([0.0; 4]));
        renderer.record_into(cmd, &shot, &target, load).unwrap();
        image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
    });
    image.numbers()
}

#[test]
fn slabs_are_the_same_whatever_a_host_leaves_out() {
    let host = Host::new();
    let mut numbers = Numbers(53);
    for nth in 0..12 {
        let mut stage = Stage::new(Settings {
            preintegrated: true,
            lattice: [Lattice::Ray, Lattice::Planes][nth % 2],
            // Of the last a slab is longer than cells know of.
            samples_per_voxel: [2.3, 1.0, 0.4][nth % 3],
            ..Settings::default()
        });
        stage.settings.conformance = nth % 4 == 3;
        let center = numbers.point() * dvec3(14.0, 10.0, 8.0) + dvec3(13.0, 10.0, 9.0);
        let ball = |p: DVec3| 100.0 * (11.0 - p.distance(center)).clamp(0.0, 1.0);
        stage.volume = volume_of(DIMS, sheared_affine(), ball);
        stage.transfer = hills(&mut numbers, [0.0, 100.0]);
        stage.transfer.opacity = [(20.0, 0.0), (40.0, 0.8)]
            .map(|(value, opacity)| OpacityPoint { value, opacity })
            .into();
        stage.camera = cameras(&stage.volume.grid())[nth % 2];
        let found = drawn(&host, &stage);
        stage.settings.skip = false;
        let wanted = offscreen(&stage);
        let differ = found.iter().zip(&wanted).filter(|(a, b)| a != b).count();
        assert_eq!(differ, 0, "pixels that differ, {:?}", stage.settings);
    }
}
