//! Round cones and triangles that a host has drawn by [`Geometry`]: against the CPU's own pass, in closed form, before a volume, and
//! what is refused.

mod closed_form;
mod formats;
mod refused;
mod seen;
mod volume;

use crate::embed_shared::{ATTACHED, DepthImage, Host, HostImage};
use ash::vk;
use stratavox::camera::{Camera, DepthConvention, HostDepth};
use stratavox::embed::{FrameInfo, Geometry, GeometryDesc};
use stratavox::geometry;
use stratavox::gpu::{DepthClass, TargetClass};
use stratavox::picture::ColorSpace;

/// What is drawn there is what was computed, to the bit.
const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

fn desc(nearer: DepthConvention) -> GeometryDesc {
    GeometryDesc {
        target: TargetClass {
            depth: Some(DepthClass {
                format: vk::Format::D32_SFLOAT,
                has_stencil: false,
                is_reversed: nearer == DepthConvention::Reversed,
            }),
            ..FORMAT.into()
        },
        color_space: ColorSpace::Linear,
        frames_in_flight: 1,
    }
}

/// A host's picture and depth buffer with geometry in them.
struct Drawn<'h> {
    pixels: Vec<[f64; 4]>,
    depths: Vec<f32>,
    /// Attached.
    buffer: DepthImage<'h>,
}

fn drawn<'h>(
    host: &'h Host,
    shapes: &geometry::Geometry,
    (camera, depth): (&Camera, &HostDepth),
    extent: [u32; 2],
) -> Drawn<'h> {
    drawn_in(host, shapes, (camera, depth), (extent, desc(depth.nearer)))
}

/// The same in another depth format.
fn drawn_in<'h>(
    host: &'h Host,
    shapes: &geometry::Geometry,
    (camera, depth): (&Camera, &HostDepth),
    (extent, desc): ([u32; 2], GeometryDesc),
) -> Drawn<'h> {
    let format = desc.target.depth.unwrap().format;
    let mut geometry = Geometry::new(host.gpu(), shapes, desc).unwrap();
    let image = HostImage::new(host, FORMAT, extent);
    let far = 1.0 - depth.nearer.near() as f32;
    let nothing = vec![far; (extent[0] * extent[1]) as usize];
    let buffer = DepthImage::of_format(host, format, extent, &nothing, ATTACHED);
    let shot = FrameInfo {
        frame: 0,
        camera,
        depth: Some(*depth),
    };
    // SAFETY: recorded in order; all of it lives until `run` has waited.
    host.run(|cmd| unsafe {
        geometry.record_upload(cmd).unwrap();
        image.make_target(cmd);
        host.begin_rendering_before(cmd, image.view, extent, [0.0; 4], Some(&buffer));
        geometry.draw(cmd, &shot, extent).unwrap();
        host.device.cmd_end_rendering(cmd);
        image.fetch_drawn(cmd);
    });
    Drawn {
        pixels: image.numbers(),
        depths: match format {
            vk::Format::D32_SFLOAT => buffer.numbers(),
            _ => Vec::new(),
        },
        buffer,
    }
}
