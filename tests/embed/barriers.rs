//! Each barrier that `docs/embedding.md` asks of a host is needed: without it the layer speaks. Looked at only under
//! `STRATAVOX_VALIDATION=sync`, and skipped elsewhere.

use crate::embed_shared::{ATTACHED, DepthImage, Host, HostImage, READ, Stage};
use ash::vk;
use glam::dcamera::rh::proj::vulkan;
use glam::dcamera::rh::view::look_at_mat4;
use std::sync::Arc;
use stratavox::camera::{Camera, DepthConvention, HostDepth};
use stratavox::embed::{FrameInfo, HostDepthImage, Renderer, RendererDesc, Volume};
use stratavox::gpu::{DepthClass, Load, Target, TargetClass, TargetState, Use, ValidationMode};
use stratavox::technique::Settings;

const FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

type State = (vk::PipelineStageFlags, vk::AccessFlags, vk::ImageLayout);

/// The same layouts, and nothing waited for: for the layer to speak of that alone.
fn unordered([before, after]: [State; 2]) -> [State; 2] {
    let nothing = vk::AccessFlags::empty();
    [
        (vk::PipelineStageFlags::TOP_OF_PIPE, nothing, before.2),
        (vk::PipelineStageFlags::BOTTOM_OF_PIPE, nothing, after.2),
    ]
}

fn unordered_state(state: Use) -> TargetState {
    TargetState {
        stage: vk::PipelineStageFlags2::NONE,
        access: vk::AccessFlags2::NONE,
        ..state.into()
    }
}

fn eye(stage: &Stage) -> (Camera, HostDepth) {
    let Camera {
        eye, target, up, ..
    } = stage.camera;
    let distance = eye.distance(target);
    let clip = vulkan::perspective(0.4, 1.2, 0.1 * distance, 9.0 * distance);
    Camera::from_matrices(
        &look_at_mat4(eye, target, up),
        &clip,
        DepthConvention::Standard,
    )
    .unwrap()
}

fn uploaded(host: &Host, stage: &Stage) -> Arc<Volume> {
    let mut volume = Volume::new(host.gpu(), &stage.volume, &stage.settings).unwrap();
    // SAFETY: outside rendering; `run` waits.
    host.run(|cmd| unsafe { volume.record_upload(host.gpu(), cmd).unwrap() });
    Arc::new(volume)
}

/// A host's depth pass, rays that end there, and its rendering with the same depth. Barrier number `missing` orders
/// nothing.
fn level_a(missing: Option<usize>) -> Vec<String> {
    let host = Host::new();
    let stage = Stage::new(Settings::default());
    let extent = stage.extent;
    let (camera, depth) = eye(&stage);
    let volume = uploaded(&host, &stage);
    let open = vec![1.0; (extent[0] * extent[1]) as usize];
    let buffer = DepthImage::new(&host, extent, &open, ATTACHED);
    let image = HostImage::new(&host, FORMAT, extent);
    let class = RendererDesc {
        settings: stage.settings.clone(),
        target: TargetClass {
            depth: Some(DepthClass {
                format: vk::Format::D32_SFLOAT,
                has_stencil: false,
                is_reversed: false,
            }),
            ..FORMAT.into()
        },
        frames_in_flight: 1,
        host_depth: true,
        gives_depth: true,
        picks: false,
        slice_blending: Default::default(),
    };
    // SAFETY: the buffer outlives the renderer.
    let read = [unsafe { HostDepthImage::new(buffer.view, READ.2, extent) }];
    let function = Some(&stage.transfer);
    let mut renderer = Renderer::new(host.gpu(), &volume, function, class, extent, &read).unwrap();
    let (frame, camera, depth) = (0, &camera, Some(depth));
    // SAFETY: the commands are a host's, in order but for what is missing; all of it lives until `run` has waited.
    host.run(|cmd| unsafe {
        let barrier = |number, states: [State; 2]| {
            let is_missing = missing == Some(number);
            let [before, after] = if is_missing {
                unordered(states)
            } else {
                states
            };
            buffer.barrier(cmd, before, after);
        };
        image.make_target(cmd);
        host.begin_rendering_before(cmd, image.view, extent, [0.0; 4], Some(&buffer));
        host.device.cmd_end_rendering(cmd);
        barrier(0, [ATTACHED, READ]);
        renderer
            .record(
                cmd,
                &FrameInfo {
                    frame,
                    camera,
                    depth,
                },
            )
            .unwrap();
        barrier(1, [READ, ATTACHED]);
        image.make_target(cmd);
        host.begin_rendering_before(cmd, image.view, extent, [0.0; 4], Some(&buffer));
        renderer.draw(cmd, 0).unwrap();
        renderer.draw_depth(cmd, 0).unwrap();
        host.device.cmd_end_rendering(cmd);
    });
    host.take_messages()
}

/// An image that a host has cleared, drawn over, and copied. State number `missing` orders nothing.
fn level_b(missing: Option<usize>) -> Vec<String> {
    let host = Host::new();
    let stage = Stage::new(Settings::default());
    let volume = uploaded(&host, &stage);
    let image = HostImage::new(&host, FORMAT, stage.extent);
    let class = RendererDesc {
        settings: stage.settings.clone(),
        target: FORMAT.into(),
        frames_in_flight: 1,
        host_depth: false,
        gives_depth: false,
        picks: false,
        slice_blending: Default::default(),
    };
    let (function, extent) = (Some(&stage.transfer), stage.extent);
    let mut renderer = Renderer::new(host.gpu(), &volume, function, class, extent, &[]).unwrap();
    let state = |number, state: Use| match missing == Some(number) {
        true => unordered_state(state),
        false => state.into(),
    };
    let target = Target {
        image: image.raw,
        view: image.view,
        format: FORMAT,
        extent,
        before: state(0, Use::TransferWrite),
        after: state(1, Use::TransferRead),
    };
    let shot = FrameInfo {
        frame: 0,
        camera: &stage.camera,
        depth: None,
    };
    // SAFETY: as above.
    host.run(|cmd| unsafe {
        image.clear(cmd, [0.25; 4]);
        renderer
            .record_into(cmd, &shot, &target, Load::Keep)
            .unwrap();
        image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
    });
    host.take_messages()
}

#[test]
fn without_any_one_of_a_hosts_barriers_the_layer_speaks() {
    let mode = stratavox::gpu::Validation::default().mode().unwrap();
    if mode != Some(ValidationMode::Synchronization) {
        println!("skipped: STRATAVOX_VALIDATION=sync is not set");
        return;
    }
    assert_eq!(level_a(None), Vec::<String>::new());
    assert_eq!(level_b(None), Vec::<String>::new());
    for missing in 0..2 {
        let said = level_a(Some(missing));
        let is_told = said.iter().any(|text| text.contains("SYNC-HAZARD"));
        assert!(is_told, "level A without barrier {missing}: {said:?}");
        let said = level_b(Some(missing));
        let is_told = said.iter().any(|text| text.contains("SYNC-HAZARD"));
        assert!(is_told, "level B without state {missing}: {said:?}");
    }
}
