//! A host's rendering may be a render pass, and may have several samples a pixel: the picture is the same.

use crate::embed_shared::{ATTACHED, DepthImage, Host, HostImage, Stage};
use ash::vk;
use glam::dcamera::rh::proj::vulkan;
use glam::dcamera::rh::view::look_at_mat4;
use std::sync::Arc;
use stratavox::camera::{Camera, DepthConvention, HostDepth};
use stratavox::embed::{FrameInfo, Renderer, RendererDesc, SliceBlending, Volume};
use stratavox::gpu::{DepthClass, HostPass, TargetClass};
use stratavox::technique::{Settings, Technique};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const DRAWN: [f32; 4] = [0.25, 0.0, 0.5, 1.0];

/// What is drawn, and where slices are blended.
fn stages() -> [(Stage, SliceBlending); 5] {
    use SliceBlending::{Float, InTarget};
    let all = [
        (Technique::Raycast, Float),
        (Technique::Slices3d, Float),
        (Technique::Slices3d, InTarget),
        (Technique::Slices2d, Float),
        (Technique::Slices2d, InTarget),
    ];
    all.map(|(technique, blending)| {
        let mut stage = Stage::new(Settings {
            technique,
            ..Settings::default()
        });
        stage.settings.conformance = false;
        (stage, blending)
    })
}

/// Slices that are blended in a target with a depth attachment are tested against it.
fn renderer(
    host: &Host,
    stage: &Stage,
    target: TargetClass,
    slice_blending: SliceBlending,
) -> Renderer {
    let mut volume = Volume::new(host.gpu(), &stage.volume, &stage.settings).unwrap();
    // SAFETY: outside rendering; `run` waits.
    host.run(|cmd| unsafe { volume.record_upload(host.gpu(), cmd).unwrap() });
    let class = RendererDesc {
        settings: stage.settings.clone(),
        host_depth: target.depth.is_some() && slice_blending == SliceBlending::InTarget,
        target,
        frames_in_flight: 1,
        gives_depth: false,
        picks: false,
        slice_blending,
    };
    let (volume, function) = (Arc::new(volume), Some(&stage.transfer));
    Renderer::new(host.gpu(), &volume, function, class, stage.extent, &[]).unwrap()
}

/// A host's camera that looks as the stage's does.
fn eye(stage: &Stage) -> (Camera, HostDepth) {
    let Camera {
        eye, target, up, ..
    } = stage.camera;
    let [width, height] = stage.extent.map(f64::from);
    let distance = eye.distance(target);
    let clip = vulkan::perspective(0.4, width / height, 0.1 * distance, 9.0 * distance);
    Camera::from_matrices(
        &look_at_mat4(eye, target, up),
        &clip,
        DepthConvention::Standard,
    )
    .unwrap()
}

fn shot<'a>((camera, depth): &'a (Camera, HostDepth)) -> FrameInfo<'a> {
    FrameInfo {
        frame: 0,
        camera,
        depth: Some(*depth),
    }
}

/// One sample, dynamic rendering.
fn plainly(host: &Host, stage: &Stage, blending: SliceBlending) -> Vec<[f64; 4]> {
    let mut renderer = renderer(host, stage, FORMAT.into(), blending);
    let (eye, image) = (eye(stage), HostImage::new(host, FORMAT, stage.extent));
    // SAFETY: recorded in order; all of it lives until `run` has waited, here and below.
    host.run(|cmd| unsafe {
        renderer.record(cmd, &shot(&eye)).unwrap();
        image.make_target(cmd);
        host.begin_rendering(cmd, image.view, stage.extent, DRAWN);
        renderer.draw(cmd, 0).unwrap();
        host.device.cmd_end_rendering(cmd);
        image.fetch_drawn(cmd);
    });
    let numbers = image.numbers();
    let seen = numbers
        .iter()
        .filter(|p| p[0] != f64::from(DRAWN[0]))
        .count();
    assert!(seen > 300, "{seen} pixels show anything");
    numbers
}

#[test]
fn a_render_pass_with_a_depth_attachment_shows_the_same() {
    let host = Host::new();
    for (stage, blending) in stages() {
        let wanted = plainly(&host, &stage, blending);
        let (eye, image) = (eye(&stage), HostImage::new(&host, FORMAT, stage.extent));
        let open = vec![1.0; wanted.len()];
        let depth = DepthImage::new(&host, stage.extent, &open, ATTACHED);
        let color_layout = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
        let attachments = [
            vk::AttachmentDescription::default()
                .format(FORMAT)
                .samples(vk::SampleCountFlags::TYPE_1)
                .load_op(vk::AttachmentLoadOp::CLEAR)
                .store_op(vk::AttachmentStoreOp::STORE)
                .initial_layout(color_layout)
                .final_layout(color_layout),
            vk::AttachmentDescription::default()
                .format(vk::Format::D32_SFLOAT)
                .samples(vk::SampleCountFlags::TYPE_1)
                .load_op(vk::AttachmentLoadOp::LOAD)
                .store_op(vk::AttachmentStoreOp::STORE)
                .initial_layout(ATTACHED.2)
                .final_layout(ATTACHED.2),
        ];
        let color = [vk::AttachmentReference::default().layout(color_layout)];
        let depth_reference = vk::AttachmentReference::default()
            .attachment(1)
            .layout(ATTACHED.2);
        let nothing = vk::SubpassDescription::default();
        let subpasses = [
            nothing,
            nothing
                .color_attachments(&color)
                .depth_stencil_attachment(&depth_reference),
        ];
        let info = vk::RenderPassCreateInfo::default()
            .attachments(&attachments)
            .subpasses(&subpasses);
        let views = [image.view, depth.view];
        let [width, height] = stage.extent;
        // SAFETY: plain Vulkan; the volume is drawn in the second subpass of the host's pass.
        unsafe {
            let pass = host.device.create_render_pass(&info, None).unwrap();
            let info = vk::FramebufferCreateInfo::default()
                .render_pass(pass)
                .attachments(&views)
                .width(width)
                .height(height)
                .layers(1);
            let framebuffer = host.device.create_framebuffer(&info, None).unwrap();
            let mut renderer = renderer(
                &host,
                &stage,
                TargetClass {
                    depth: Some(DepthClass {
                        format: vk::Format::D32_SFLOAT,
                        has_stencil: false,
                        is_reversed: false,
                    }),
                    pass: Some(HostPass::new(pass, 1)),
                    ..FORMAT.into()
                },
                blending,
            );
            host.run(|cmd| {
                renderer.record(cmd, &shot(&eye)).unwrap();
                image.make_target(cmd);
                let clear = [vk::ClearValue {
                    color: vk::ClearColorValue { float32: DRAWN },
                }];
                let info = vk::RenderPassBeginInfo::default()
                    .render_pass(pass)
                    .framebuffer(framebuffer)
                    .render_area(vk::Extent2D { width, height }.into())
                    .clear_values(&clear);
                let inline = vk::SubpassContents::INLINE;
                host.device.cmd_begin_render_pass(cmd, &info, inline);
                host.device.cmd_next_subpass(cmd, inline);
                renderer.draw(cmd, 0).unwrap();
                host.device.cmd_end_render_pass(cmd);
                image.fetch_drawn(cmd);
            });
            drop(renderer);
            host.device.destroy_framebuffer(framebuffer, None);
            host.device.destroy_render_pass(pass, None);
        }
        assert!(image.numbers() == wanted, "{:?}", stage.settings.technique);
    }
}

#[test]
fn four_samples_a_pixel_show_what_one_shows() {
    let host = Host::new();
    let samples = vk::SampleCountFlags::TYPE_4;
    for (stage, blending) in stages() {
        let wanted = plainly(&host, &stage, blending);
        let (eye, extent) = (eye(&stage), stage.extent);
        let image = HostImage::new(&host, FORMAT, extent);
        let several = HostImage::of_samples(&host, FORMAT, extent, samples);
        let mut renderer = renderer(
            &host,
            &stage,
            TargetClass {
                samples,
                ..FORMAT.into()
            },
            blending,
        );
        let layout = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
        let attachments = [vk::RenderingAttachmentInfo::default()
            .image_view(several.view)
            .image_layout(layout)
            .resolve_mode(vk::ResolveModeFlags::AVERAGE)
            .resolve_image_view(image.view)
            .resolve_image_layout(layout)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::DONT_CARE)
            .clear_value(vk::ClearValue {
                color: vk::ClearColorValue { float32: DRAWN },
            })];
        let [width, height] = extent;
        let info = vk::RenderingInfo::default()
            .render_area(vk::Extent2D { width, height }.into())
            .layer_count(1)
            .color_attachments(&attachments);
        // SAFETY: as above.
        host.run(|cmd| unsafe {
            renderer.record(cmd, &shot(&eye)).unwrap();
            image.make_target(cmd);
            several.make_target(cmd);
            host.device.cmd_begin_rendering(cmd, &info);
            renderer.draw(cmd, 0).unwrap();
            host.device.cmd_end_rendering(cmd);
            image.fetch_drawn(cmd);
        });
        // The mean of four equal numbers: two roundings.
        for (i, (found, wanted)) in image.numbers().iter().zip(&wanted).enumerate() {
            for c in 0..4 {
                let off = (found[c] - wanted[c]).abs();
                let what = format!("{:?}, pixel {i}: {off}", stage.settings.technique);
                assert!(off <= 2f64.powi(-22), "{what}");
            }
        }
    }
}
