//! One draw with a depth attachment, and both attachments back.

use super::kit;
use super::raw::{self, DEPTH_TARGET, DepthPipeline, RawImage};
use crate::conformance::case::Stop;
use crate::conformance::test_bed::TestBed;
use crate::gpu::{Bindings, Resource, Use, image_barrier};
use ash::vk;
use std::sync::Arc;

/// A format of depth, and how its numbers are kept.
#[derive(Clone, Copy, Debug)]
pub struct Kept {
    pub word: &'static str,
    pub format: vk::Format,
    /// The largest code; `None`: 32-bit floats.
    pub most: Option<f64>,
    bytes: usize,
}

/// Those without stencil. Vulkan demands the first, and one of the others, or one of 24 or 32 bits with stencil.
pub const FORMATS: [Kept; 3] = [
    Kept {
        word: "d16_unorm",
        format: vk::Format::D16_UNORM,
        most: Some(65_535.0),
        bytes: 2,
    },
    Kept {
        word: "x8_d24_unorm",
        format: vk::Format::X8_D24_UNORM_PACK32,
        most: Some(16_777_215.0),
        bytes: 4,
    },
    Kept {
        word: "d32_sfloat",
        format: vk::Format::D32_SFLOAT,
        most: None,
        bytes: 4,
    },
];

impl Kept {
    /// The smallest and the largest number that may be kept of a depth. A product in 32-bit floats rounds once.
    pub fn candidates(self, z: f64) -> [f64; 2] {
        match self.most {
            Some(most) if z > 0.0 && z < 1.0 => {
                let rounded = super::plane::SINGLE * z * most;
                [
                    (z * most - rounded).floor().max(0.0) / most,
                    (z * most + rounded).ceil().min(most) / most,
                ]
            }
            _ => [z, z],
        }
    }

    /// The number of the nearest code.
    pub fn stored(self, z: f64) -> f64 {
        match self.most {
            Some(most) => (z * most).round() / most,
            None => f64::from(z as f32),
        }
    }

    fn encoded(self, z: f32) -> Vec<u8> {
        let bytes = match self.most {
            Some(most) => ((f64::from(z) * most).round() as u32).to_le_bytes(),
            None => z.to_le_bytes(),
        };
        bytes[..self.bytes].to_vec()
    }

    fn decoded(self, bytes: &[u8]) -> f64 {
        let mut word = [0; 4];
        word[..self.bytes].copy_from_slice(bytes);
        match self.most {
            // The upper bits of 24 are nobody's.
            Some(most) => f64::from(u32::from_le_bytes(word) & most as u32) / most,
            None => f32::from_le_bytes(word).into(),
        }
    }
}

/// Pixels across; `shaders/probe/depth.wgsl` knows it.
pub const WIDTH: usize = 64;

/// What the depth attachment holds before.
#[derive(Clone, Copy)]
pub enum Source<'a> {
    Clear(f32),
    Copied(&'a [f32]),
}

/// What to draw.
#[derive(Clone, Copy)]
pub struct Picture<'a> {
    pub kept: Kept,
    pub height: u32,
    pub before: Source<'a>,
    /// Three a triangle, in clip space.
    pub corners: &'a [[f32; 4]],
    /// One a triangle, again and again.
    pub colors: &'a [[f32; 4]],
    /// Depths of the pixels' own.
    pub depths: Option<&'a [f32]>,
    pub compare: vk::CompareOp,
    pub writes: bool,
    /// Of the viewport.
    pub range: [f32; 2],
}

/// First channels, and depths.
pub struct Drawn {
    pub colors: Vec<f32>,
    pub depths: Vec<f64>,
}

/// Draws in one call.
pub fn draw(bed: &mut TestBed, picture: &Picture<'_>) -> Result<Drawn, Stop> {
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let kept = picture.kept;
    let extent = [WIDTH as u32, picture.height];
    let whole = [extent[0], extent[1], 1];
    let pixels = WIDTH * picture.height as usize;
    let target = kit::target(&gpu, vk::Format::R32G32B32A32_SFLOAT, extent)?;
    let usage = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT
        | vk::ImageUsageFlags::TRANSFER_SRC
        | vk::ImageUsageFlags::TRANSFER_DST;
    let info = vk::ImageCreateInfo::default()
        .image_type(vk::ImageType::TYPE_2D)
        .format(kept.format)
        .extent(vk::Extent3D {
            width: whole[0],
            height: whole[1],
            depth: 1,
        })
        .mip_levels(1)
        .array_layers(1)
        .samples(vk::SampleCountFlags::TYPE_1)
        .usage(usage);
    let depth = RawImage::new(&gpu, &info, vk::ImageAspectFlags::DEPTH)?;
    let bytes = (kept.bytes * pixels) as u64;
    let from = raw::copied(&gpu, bytes, true)?;
    if let Source::Copied(before) = picture.before {
        let codes: Vec<u8> = before.iter().flat_map(|&z| kept.encoded(z)).collect();
        from.write(0, &codes)?;
    }
    let back = raw::copied(&gpu, bytes, false)?;
    let fragment = match picture.depths {
        Some(_) => "probe/depth",
        None => "probe/color",
    };
    let shaders = ["probe/shapes", fragment];
    let pipeline = DepthPipeline::new(&gpu, shaders, kept.format, picture.compare, picture.writes)?;
    let corners = kit::buffer(&gpu, picture.corners, "corners")?;
    let colors = kit::buffer(&gpu, picture.colors, "colors")?;
    let depths = kit::buffer(&gpu, picture.depths.unwrap_or(&[0.0]), "depths")?;
    let mut given = vec![
        ("corners", Resource::Storage(&corners)),
        ("colors", Resource::Storage(&colors)),
    ];
    if picture.depths.is_some() {
        given.push(("depths", Resource::Storage(&depths)));
    }
    let bindings = Bindings::new(&gpu, pipeline.layout(), &given)?;
    let device_of = gpu.device();
    device.run(|cmd| {
        // SAFETY: recorded in order, with barriers between; `run` waits, and all that is bound lives meanwhile.
        unsafe {
            image_barrier(&gpu, cmd, &target, Use::Nothing, Use::ColorTarget);
            let load = match picture.before {
                Source::Clear(z) => {
                    depth.barrier(cmd, Use::Nothing.state(), DEPTH_TARGET);
                    (vk::AttachmentLoadOp::CLEAR, z)
                }
                Source::Copied(_) => {
                    let to = Use::TransferWrite.state();
                    depth.barrier(cmd, Use::Nothing.state(), to);
                    let region = [depth.whole(whole)];
                    device_of.cmd_copy_buffer_to_image(cmd, from.raw(), depth.raw(), to.2, &region);
                    depth.barrier(cmd, to, DEPTH_TARGET);
                    (vk::AttachmentLoadOp::LOAD, 0.0)
                }
            };
            begin(device_of, cmd, [target.view(), depth.view()], load, extent);
            let viewport = vk::Viewport {
                x: 0.0,
                y: 0.0,
                width: extent[0] as f32,
                height: extent[1] as f32,
                min_depth: picture.range[0],
                max_depth: picture.range[1],
            };
            device_of.cmd_set_viewport(cmd, 0, &[viewport]);
            device_of.cmd_set_scissor(cmd, 0, &[area(extent)]);
            pipeline.draw(cmd, &bindings, picture.corners.len() as u32);
            device_of.cmd_end_rendering(cmd);
            let read = Use::TransferRead.state();
            depth.barrier(cmd, DEPTH_TARGET, read);
            let region = [depth.whole(whole)];
            device_of.cmd_copy_image_to_buffer(cmd, depth.raw(), read.2, back.raw(), &region);
        }
        Ok(())
    })?;
    let texels = kit::texels(device, &target, Use::ColorTarget)?;
    let colors = texels.as_chunks::<16>().0.iter();
    let colors = colors.map(|t| f32::from_le_bytes([t[0], t[1], t[2], t[3]]));
    let found: Vec<u8> = kit::read(&back)?;
    let depths = found.chunks_exact(kept.bytes).take(pixels);
    Ok(Drawn {
        colors: colors.collect(),
        depths: depths.map(|bytes| kept.decoded(bytes)).collect(),
    })
}

fn area([width, height]: [u32; 2]) -> vk::Rect2D {
    vk::Rect2D {
        offset: vk::Offset2D::default(),
        extent: vk::Extent2D { width, height },
    }
}

/// # Safety
/// `cmd` is recording on the device, outside rendering; both images are attachments of that extent.
unsafe fn begin(
    device: &ash::Device,
    cmd: vk::CommandBuffer,
    [color, depth]: [vk::ImageView; 2],
    (load, z): (vk::AttachmentLoadOp, f32),
    extent: [u32; 2],
) {
    let colors = [vk::RenderingAttachmentInfo::default()
        .image_view(color)
        .image_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
        .load_op(vk::AttachmentLoadOp::CLEAR)
        .store_op(vk::AttachmentStoreOp::STORE)];
    let depth = vk::RenderingAttachmentInfo::default()
        .image_view(depth)
        .image_layout(DEPTH_TARGET.2)
        .load_op(load)
        .store_op(vk::AttachmentStoreOp::STORE)
        .clear_value(vk::ClearValue {
            depth_stencil: vk::ClearDepthStencilValue {
                depth: z,
                stencil: 0,
            },
        });
    let info = vk::RenderingInfo::default()
        .render_area(area(extent))
        .layer_count(1)
        .color_attachments(&colors)
        .depth_attachment(&depth);
    // SAFETY: the caller's promise; dynamicRendering was required of the device.
    unsafe { device.cmd_begin_rendering(cmd, &info) };
}
