//! A host's images arrive and leave as the host says ([`stratavox::gpu::Target`]), and the host's watchers
//! are alive: its messenger hears a mistake, and its loader catches what is the host's alone to call.

use crate::embed_shared::{Host, HostImage, OnDevice, Stage, assert_close, over};
use ash::vk;
use std::process::Command;
use stratavox::gpu::{Load, Target, TargetState, Use, begin_rendering, end_rendering};
use stratavox::technique::blend::Drawn;
use stratavox::technique::{
    Inputs, Mode, Settings, ShaderVariant, Slicer, Technique, parameter_ring,
};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const DRAWN: [f32; 4] = [0.25, 0.0, 0.5, 1.0];

/// A layout with who is in it, in the words of the host's own barriers and of ours.
type Place = (vk::PipelineStageFlags, vk::AccessFlags, vk::ImageLayout);

fn state(
    (_, _, layout): Place,
    stage: vk::PipelineStageFlags2,
    access: vk::AccessFlags2,
) -> TargetState {
    TargetState {
        layout,
        stage,
        access,
        queue_family: vk::QUEUE_FAMILY_IGNORED,
    }
}

const CLEARED: Place = (
    vk::PipelineStageFlags::TRANSFER,
    vk::AccessFlags::TRANSFER_WRITE,
    vk::ImageLayout::TRANSFER_DST_OPTIMAL,
);

/// The host clears its image with a transfer, we draw slices over it, and the host takes it from `layout`.
fn drawn_and_left_in(layout: vk::ImageLayout) {
    let host = Host::new();
    let gpu = host.gpu();
    let stage = Stage::new(Settings {
        technique: Technique::Slices3d,
        ..Settings::default()
    });
    let there = OnDevice::new(&host, &stage);
    let words = ShaderVariant::of(&stage.settings, &there.volume);
    let ring = parameter_ring(gpu, 1).unwrap();
    let picture = Drawn::Picture(Mode::Composite);
    let order = stage.settings.order;
    let pass = Slicer::new(gpu, Technique::Slices3d, picture, order, &words, FORMAT).unwrap();
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
    let bound = pass.bind(&inputs).unwrap();
    let image = HostImage::new(&host, FORMAT, stage.extent);
    let taken: Place = (
        vk::PipelineStageFlags::TRANSFER,
        vk::AccessFlags::TRANSFER_READ,
        layout,
    );
    let target = Target {
        image: image.raw,
        view: image.view,
        format: FORMAT,
        extent: stage.extent,
        before: state(
            CLEARED,
            vk::PipelineStageFlags2::ALL_TRANSFER,
            vk::AccessFlags2::TRANSFER_WRITE,
        ),
        after: state(
            taken,
            vk::PipelineStageFlags2::ALL_TRANSFER,
            vk::AccessFlags2::TRANSFER_READ,
        ),
    };
    let recordings = stage
        .view()
        .recordings(&there.volume, Some(&there.transfer));
    let recording = recordings.unwrap()[0];
    let offset = recording.write(&ring, 0).unwrap();
    // SAFETY: the target arrives as it says; all of it lives until `run` has waited.
    host.run(|cmd| unsafe {
        image.clear(cmd, DRAWN);
        target.enter(gpu, cmd, Use::ColorTarget);
        begin_rendering(gpu, cmd, &[(target.view, Load::Keep)], target.extent);
        pass.record(cmd, &bound, offset, target.extent, 0..recording.slices);
        end_rendering(gpu, cmd);
        target.leave(gpu, cmd, Use::ColorTarget);
        image.fetch(cmd, taken);
    });
    let wanted: Vec<_> = stage.reference().iter().map(|&p| over(p, DRAWN)).collect();
    assert_close(
        &image,
        &wanted,
        recording.slices,
        &format!("left in {layout:?}"),
    );
}

#[test]
fn a_target_arrives_with_its_content_and_leaves_in_the_layout_that_the_host_wants() {
    for layout in [
        vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
        vk::ImageLayout::GENERAL,
    ] {
        drawn_and_left_in(layout);
    }
}

#[test]
fn the_hosts_messenger_hears_a_wrong_layout() {
    let host = Host::new();
    if host.mode.is_none() {
        println!("skipped: no validation");
        return;
    }
    let image = HostImage::new(&host, FORMAT, [4, 4]);
    // SAFETY: the layout is the mistake; drivers and layer survive it.
    host.run(|cmd| unsafe {
        image.make_target(cmd);
        image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
    });
    let messages = host.take_messages();
    assert!(
        messages
            .iter()
            .any(|text| text.contains("TRANSFER_SRC_OPTIMAL")),
        "nothing about the layout in {messages:#?}"
    );
}

#[test]
fn the_hosts_loader_catches_a_wait_that_is_not_the_hosts() {
    const VARIABLE: &str = "STRATAVOX_TEST_TRAP";
    const NAME: &str = "layouts::the_hosts_loader_catches_a_wait_that_is_not_the_hosts";
    if std::env::var_os(VARIABLE).is_some() {
        let host = Host::new();
        // SAFETY: the device is valid. That this goes through stratavox's functions is the mistake.
        unsafe { host.gpu().device().device_wait_idle().unwrap() };
        return;
    }
    let child = Command::new(std::env::current_exe().unwrap())
        .args([NAME, "--exact", "--nocapture"])
        .env(VARIABLE, "1")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&child.stderr);
    assert!(!child.status.success(), "the child came through");
    assert!(said.contains("vkDeviceWaitIdle"), "the child said {said}");
}
