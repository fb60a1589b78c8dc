//! Eyes of a host around a stage, the spheres that it has drawn there, and a volume that is drawn among them.

use super::{ATTACHED, DepthImage, Host, HostImage, READ, Stage};
use ash::vk;
use glam::dcamera::rh::proj::vulkan;
use glam::dcamera::rh::view::look_at_mat4;
use glam::{DMat4, DVec3};
use std::sync::Arc;
use stratavox::camera::{Camera, DepthConvention, HostDepth};
use stratavox::embed::{FrameInfo, HostDepthImage, Pick, Renderer, RendererDesc, Volume};
use stratavox::gpu::{DepthClass, TargetClass};
use stratavox::technique::Technique;

/// What is drawn there is what was computed, to the bit.
const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// A host's matrices around the stage, and which of its depths is nearer.
pub struct Eye {
    pub name: &'static str,
    pub view: DMat4,
    pub clip: DMat4,
    pub nearer: DepthConvention,
}

pub fn eyes(stage: &Stage) -> [Eye; 4] {
    let Camera {
        eye, target, up, ..
    } = stage.camera;
    let view = look_at_mat4(eye, target, up);
    let [width, height] = stage.extent.map(f64::from);
    let (aspect, distance) = (width / height, eye.distance(target));
    let (half_height, fov) = (0.16 * distance, 0.34);
    let half_width = aspect * half_height;
    let (near, far) = (0.2 * distance, 4.0 * distance);
    [
        Eye {
            name: "perspective",
            view,
            clip: vulkan::perspective(fov, aspect, near, far),
            nearer: DepthConvention::Standard,
        },
        // Its near plane cuts the volume.
        Eye {
            name: "perspective, reversed, without a far plane",
            view,
            clip: vulkan::perspective_infinite_reverse(fov, aspect, 0.95 * distance),
            nearer: DepthConvention::Reversed,
        },
        Eye {
            name: "orthographic",
            view,
            clip: vulkan::orthographic(
                -half_width,
                half_width,
                -half_height,
                half_height,
                near,
                far,
            ),
            nearer: DepthConvention::Standard,
        },
        // Off the middle, and its far plane cuts the volume.
        Eye {
            name: "orthographic, reversed",
            view,
            clip: vulkan::orthographic(
                -0.5 * half_width,
                1.5 * half_width,
                -half_height,
                half_height,
                1.05 * distance,
                -far,
            ),
            nearer: DepthConvention::Reversed,
        },
    ]
}

/// Centre and radius: inside, before and behind the volume.
pub fn spheres(stage: &Stage) -> [(DVec3, f64); 3] {
    let center = stage.grid.center();
    let away = (center - stage.camera.eye).normalize();
    let aside = away.cross(DVec3::Z).normalize();
    [
        (center + 1.5 * aside, 4.0),
        (center - 16.0 * away - 4.0 * aside, 2.0),
        (center + 18.0 * away + 2.0 * aside, 9.0),
    ]
}

/// The depth buffer that a host would have after it has drawn the spheres exactly.
pub fn depths(stage: &Stage, camera: &Camera, depth: &HostDepth) -> Vec<f32> {
    let rays = camera.rays(stage.extent);
    let [width, height] = stage.extent;
    let pixels = (0..width * height).map(|i| [i % width, i / width].map(|n| f64::from(n) + 0.5));
    let spheres = spheres(stage);
    let far = 1.0 - depth.nearer.near();
    let of_pixel = |[x, y]: [f64; 2]| {
        let (origin, direction) = rays.at(x, y);
        let hit = |(center, radius): (DVec3, f64)| {
            let to_center = center - origin;
            let along = to_center.dot(direction);
            let inside = radius * radius - (to_center.length_squared() - along * along);
            (inside > 0.0).then(|| along - inside.sqrt())
        };
        let nearest = spheres.into_iter().filter_map(hit).reduce(f64::min);
        let found = nearest.map(|t| depth.of(origin + t * direction));
        // What the host's own near and far planes cut away.
        let found = found.filter(|depth| (0.0..=1.0).contains(depth));
        found.unwrap_or(far) as f32
    };
    pixels.map(of_pixel).collect()
}

/// What a host gets.
pub struct Found {
    pub pixels: Vec<[f64; 4]>,
    pub depths: Vec<f32>,
    pub pick: Option<Pick>,
}

/// What a host gets that draws the volume behind `drawn`; depth is given back where the mode has one, and a pixel
/// picked.
pub fn draw(
    host: &Host,
    stage: &Stage,
    camera: &Camera,
    depth: &HostDepth,
    drawn: &[f32],
    pixel: Option<[u32; 2]>,
) -> Found {
    let is_mean = stage.settings.technique == Technique::Pathtrace;
    let gives_depth = stage.settings.mode.has_depth() && !is_mean;
    let mut volume = Volume::new(host.gpu(), &stage.volume, &stage.settings).unwrap();
    let image = HostImage::new(host, FORMAT, stage.extent);
    let class = RendererDesc {
        settings: stage.settings.clone(),
        target: TargetClass {
            depth: Some(DepthClass {
                format: vk::Format::D32_SFLOAT,
                has_stencil: false,
                is_reversed: depth.nearer == DepthConvention::Reversed,
            }),
            ..FORMAT.into()
        },
        frames_in_flight: 1,
        host_depth: true,
        gives_depth,
        picks: false,
        slice_blending: Default::default(),
    };
    let reads = class.reads_host_depth();
    let state = if reads { READ } else { ATTACHED };
    let buffer = DepthImage::new(host, stage.extent, drawn, state);
    // SAFETY: the buffer outlives the renderer.
    let read = unsafe { HostDepthImage::new(buffer.view, READ.2, stage.extent) };
    let read = if reads { vec![read] } else { Vec::new() };
    let shot = FrameInfo {
        frame: 0,
        camera,
        depth: Some(*depth),
    };
    // SAFETY: recorded in order; all of it lives until `run` has waited.
    host.run(|cmd| unsafe { volume.record_upload(host.gpu(), cmd).unwrap() });
    let volume = Arc::new(volume);
    let function = Some(&stage.transfer);
    let mut renderer =
        Renderer::new(host.gpu(), &volume, function, class, stage.extent, &read).unwrap();
    // SAFETY: as above.
    host.run(|cmd| unsafe {
        renderer.record(cmd, &shot).unwrap();
        if let Some(pixel) = pixel {
            renderer.record_pick(cmd, 0, pixel).unwrap();
        }
        image.make_target(cmd);
        if reads {
            buffer.barrier(cmd, READ, ATTACHED);
        }
        let depth = Some(&buffer);
        host.begin_rendering_before(cmd, image.view, stage.extent, [0.0; 4], depth);
        renderer.draw(cmd, 0).unwrap();
        if gives_depth {
            renderer.draw_depth(cmd, 0).unwrap();
        }
        host.device.cmd_end_rendering(cmd);
        image.fetch_drawn(cmd);
    });
    Found {
        pixels: image.numbers(),
        depths: buffer.numbers(),
        pick: pixel.and_then(|pixel| renderer.pick(0, pixel).unwrap()),
    }
}
