//! Depths of 16 and 24 bits: what is nearer by more than their steps hides the rest, as in 32.

use super::{Drawn, FORMAT, desc, drawn_in};
use crate::embed_shared::{ATTACHED, DepthImage, Host, HostImage, Stage, eyes};
use ash::vk;
use stratavox::camera::Camera;
use stratavox::embed::{FrameInfo, Geometry, GeometryDesc};
use stratavox::geometry::{self, RoundCones, Vertex};
use stratavox::technique::Settings;

const EXTENT: [u32; 2] = [90, 70];

/// Two tubes across each other, the nearer one first, of one cone each: nothing else is as near as another.
fn tubes(stage: &Stage) -> (geometry::Geometry, [glam::DVec3; 2]) {
    let center = stage.grid.center();
    let away = (center - stage.camera.eye).normalize();
    let aside = away.cross(glam::DVec3::Z).normalize();
    let up = aside.cross(away);
    let places = [center - 4.0 * away, center + 4.0 * away];
    let mut cones = RoundCones::default();
    for (middle, along) in places.into_iter().zip([aside, up]) {
        cones.add_line([-9.0, 9.0].map(|part| Vertex {
            place: middle + part * along,
            radius: 1.5,
            color: [0.9, 0.4 + part as f32 / 30.0, 0.2],
        }));
    }
    (cones.into(), places)
}

#[test]
fn depths_of_16_and_24_bits_hide_what_lies_behind() {
    let host = Host::new();
    let stage = Stage::new(Settings::default());
    let (shapes, [near, far]) = tubes(&stage);
    for eye in eyes(&stage).into_iter().take(3) {
        let (camera, depth) = Camera::from_matrices(&eye.view, &eye.clip, eye.nearer).unwrap();
        // One step is less than lies between them, less both radii.
        let apart = (depth.of(far) - depth.of(near)).abs() * 5.0 / 8.0;
        assert!(apart > 1.0 / 65535.0, "{}: {apart:e}", eye.name);
        let of = |format| {
            let mut desc = desc(depth.nearer);
            desc.target.depth.as_mut().expect("of `desc`").format = format;
            desc
        };
        let draw = |desc: GeometryDesc| -> Drawn {
            drawn_in(&host, &shapes, (&camera, &depth), (EXTENT, desc))
        };
        let wanted = draw(of(vk::Format::D32_SFLOAT)).pixels;
        let drawn = wanted.iter().filter(|pixel| pixel[3] == 1.0).count();
        assert!(drawn > 300, "{}: {drawn} pixels", eye.name);
        for format in [vk::Format::D16_UNORM, vk::Format::X8_D24_UNORM_PACK32] {
            if let Err(problem) = Geometry::new(host.gpu(), &shapes, of(format)) {
                assert!(
                    problem.to_string().contains("depth attachment"),
                    "{problem}"
                );
                println!("skipped: {problem}");
                continue;
            }
            let found = draw(of(format)).pixels;
            assert!(found == wanted, "{}: {format:?}", eye.name);
        }
    }
}

/// All samples of a pixel see what its middle sees, and are as far away.
#[test]
fn four_samples_a_pixel_show_the_cones_that_one_shows() {
    let host = Host::new();
    let stage = Stage::new(Settings::default());
    let (shapes, _) = tubes(&stage);
    let samples = vk::SampleCountFlags::TYPE_4;
    let [eye, ..] = eyes(&stage);
    let (camera, depth) = Camera::from_matrices(&eye.view, &eye.clip, eye.nearer).unwrap();
    let mut of_four = desc(depth.nearer);
    let wanted = drawn_in(&host, &shapes, (&camera, &depth), (EXTENT, of_four)).pixels;
    of_four.target.samples = samples;
    let format = of_four.target.depth.expect("of `desc`").format;
    let mut geometry = Geometry::new(host.gpu(), &shapes, of_four).unwrap();
    let image = HostImage::new(&host, FORMAT, EXTENT);
    let several = HostImage::of_samples(&host, FORMAT, EXTENT, samples);
    let buffer = DepthImage::of_samples(&host, format, EXTENT, samples);
    let layout = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
    let colors = [vk::RenderingAttachmentInfo::default()
        .image_view(several.view)
        .image_layout(layout)
        .resolve_mode(vk::ResolveModeFlags::AVERAGE)
        .resolve_image_view(image.view)
        .resolve_image_layout(layout)
        .load_op(vk::AttachmentLoadOp::CLEAR)
        .store_op(vk::AttachmentStoreOp::DONT_CARE)];
    let far = 1.0 - depth.nearer.near() as f32;
    let depths = vk::RenderingAttachmentInfo::default()
        .image_view(buffer.view)
        .image_layout(ATTACHED.2)
        .load_op(vk::AttachmentLoadOp::CLEAR)
        .store_op(vk::AttachmentStoreOp::DONT_CARE)
        .clear_value(vk::ClearValue {
            depth_stencil: vk::ClearDepthStencilValue {
                depth: far,
                stencil: 0,
            },
        });
    let [width, height] = EXTENT;
    let info = vk::RenderingInfo::default()
        .render_area(vk::Extent2D { width, height }.into())
        .layer_count(1)
        .color_attachments(&colors)
        .depth_attachment(&depths);
    let shot = FrameInfo {
        frame: 0,
        camera: &camera,
        depth: Some(depth),
    };
    let nothing = (
        vk::PipelineStageFlags::TOP_OF_PIPE,
        vk::AccessFlags::empty(),
        vk::ImageLayout::UNDEFINED,
    );
    // SAFETY: recorded in order; all of it lives until `run` has waited.
    host.run(|cmd| unsafe {
        geometry.record_upload(cmd).unwrap();
        image.make_target(cmd);
        several.make_target(cmd);
        buffer.barrier(cmd, nothing, ATTACHED);
        host.device.cmd_begin_rendering(cmd, &info);
        geometry.draw(cmd, &shot, EXTENT).unwrap();
        host.device.cmd_end_rendering(cmd);
        image.fetch_drawn(cmd);
    });
    // The mean of four equal numbers: two roundings.
    for (i, (found, wanted)) in image.numbers().iter().zip(&wanted).enumerate() {
        for c in 0..4 {
            let off = (found[c] - wanted[c]).abs();
            assert!(off <= 2f64.powi(-22), "pixel {i}: {off}");
        }
    }
}
