//! A host records both passes into its own command buffer.

use super::{half_angle, plain, ways_to_light};
use crate::embed_shared::{Host, HostImage, OnDevice, Stage, assert_close, over};
use ash::vk;
use stratavox::gpu::{Blend, Use, image_barrier};
use stratavox::resolve::Resolve;
use stratavox::technique::slices_3d::HalfAngleSlicer;
use stratavox::technique::slices_3d::half_angle::{HalfAngleSlices, light_buffer};
use stratavox::technique::{Inputs, Mode, ShaderVariant, accumulation, parameter_ring};

#[test]
fn a_host_records_eye_and_light_into_its_own_commands() {
    let host = Host::new();
    let gpu = host.gpu();
    let mut stage = Stage::new(half_angle());
    stage.settings.shading = plain(ways_to_light(&stage.camera)[1]);
    let there = OnDevice::new(&host, &stage);
    let view = stage.view();
    let slicer =
        HalfAngleSlicer::new(gpu, &ShaderVariant::of(&stage.settings, &there.volume)).unwrap();
    let ring = parameter_ring(gpu, 2).unwrap();
    let seen = light_buffer(gpu, view.light_extent()).unwrap();
    let picture = accumulation(gpu, stage.extent, "picture").unwrap();
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
    let bound = slicer.bind(&inputs, &seen).unwrap();
    let format = vk::Format::R32G32B32A32_SFLOAT;
    let resolve = Resolve::new(gpu, Mode::Composite, Blend::Over, format).unwrap();
    let resolved = resolve
        .bind(&ring, &picture, Some(&there.transfer))
        .unwrap();
    let image = HostImage::new(&host, format, stage.extent);

    let recordings = view
        .recordings(&there.volume, Some(&there.transfer))
        .unwrap();
    let [eye, light] = &recordings[..] else {
        panic!("{} recordings", recordings.len());
    };
    let slices = HalfAngleSlices {
        offsets: [eye.write(&ring, 0).unwrap(), light.write(&ring, 1).unwrap()],
        count: eye.slices,
        order: eye.order,
    };
    const DRAWN: [f32; 4] = [0.25, 0.0, 1.0, 1.0];
    // SAFETY: barriers stand between the passes, and all of it lives until `run` has waited.
    host.run(|cmd| unsafe {
        for target in [&picture, &seen] {
            image_barrier(gpu, cmd, target, Use::Nothing, Use::ColorTarget);
        }
        slicer.record(cmd, &bound, slices, (&picture, stage.extent), &seen);
        image_barrier(gpu, cmd, &picture, Use::ColorTarget, Use::FragmentSampled);
        image.make_target(cmd);
        host.begin_rendering(cmd, image.view, stage.extent, DRAWN);
        resolve.record(cmd, &resolved, slices.offsets[0], stage.extent);
        host.device.cmd_end_rendering(cmd);
        image.fetch_drawn(cmd);
    });
    let wanted: Vec<_> = stage.reference().iter().map(|&p| over(p, DRAWN)).collect();
    assert_close(&image, &wanted, slices.count, "half-angle slices of a host");
}
