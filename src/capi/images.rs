//! Images of the host's: what is drawn into, and depths that are read.

use super::status::{Failure, number, reserved};
use super::structure::{self, Versioned};
use crate::embed::HostDepthImage;
use crate::gpu::{DepthClass, HostPass, Load, Target, TargetClass, TargetState, Use};
use ash::vk::{self, Handle};
use std::ffi::c_void;

/// What is drawn into, as far as pipelines have to know.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_target_class {
    /// `sizeof(sv_target_class)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// `VkFormat` of the one color target.
    pub color_format: u32,
    /// Samples of each target, as `VkSampleCountFlagBits`. 0 is 1.
    pub samples: u32,
    /// `VkFormat` of the depth attachment, or 0 where there is none.
    pub depth_format: u32,
    /// Not 0: the same image is the stencil attachment too.
    pub has_stencil: u32,
    /// Not 0: the larger of two depths is nearer.
    pub is_depth_reversed: u32,
    /// Of `render_pass`, with the color target as its first color attachment.
    pub subpass: u32,
    /// `VkRenderPass`, or 0 for dynamic rendering.
    pub render_pass: u64,
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_target_class {
    const NAME: &'static str = "sv_target_class";
}

/// A depth buffer that rays read: 2D, one level, one layer, one sample, with `VK_IMAGE_USAGE_SAMPLED_BIT`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_depth_image {
    /// `VkImageView` of its depth aspect.
    pub view: u64,
    /// `VkImageLayout` that it is in when a recording runs, visible to sampled reads of compute shaders.
    pub layout: u32,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// 0.
    pub reserved: u32,
}

/// The state of an image at one moment. All zero of `before`: what it holds is given up.
/// All zero of `after`: as rendering leaves it, in `VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_image_state {
    /// `VkImageLayout`.
    pub layout: u32,
    /// Not 0: `queue_family` owns the image before or after, and ownership goes from one to the other.
    pub has_queue_family: u32,
    /// Bits of `VkPipelineStageFlags2`.
    pub stage: u64,
    /// Bits of `VkAccessFlags2`.
    pub access: u64,
    /// Of the queues that own the image.
    pub queue_family: u32,
    /// 0.
    pub reserved: u32,
}

/// An image of the host's that is drawn into: one level, one layer, one sample.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_target {
    /// `sizeof(sv_target)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// `VkImage`.
    pub image: u64,
    /// `VkImageView` of it, 2D.
    pub view: u64,
    /// `VkFormat` of the view.
    pub format: u32,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Not 0: `clear_color` goes over all of it first.
    pub is_cleared: u32,
    /// Red, green, blue and alpha, premultiplied.
    pub clear_color: [f32; 4],
    /// How it arrives.
    pub before: sv_image_state,
    /// How it leaves.
    pub after: sv_image_state,
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_target {
    const NAME: &'static str = "sv_target";
}

/// Depth buffers of one renderer: as many as frames in flight.
pub(super) const MOST_FRAMES: u32 = 64;

/// # Safety
/// As [`structure::read`].
pub(super) unsafe fn target_class(c: &sv_target_class) -> Result<TargetClass, Failure> {
    let samples = if c.samples == 0 { 1 } else { c.samples };
    let is_count = samples.is_power_of_two() && samples <= 64;
    let name = "sv_target_class.samples";
    number(name, "1, 2, 4, ... 64", samples.into(), is_count)?;
    Ok(TargetClass {
        color_format: color_format("sv_target_class.color_format", c.color_format)?,
        samples: vk::SampleCountFlags::from_raw(samples),
        depth: match c.depth_format {
            0 => None,
            format => Some(DepthClass {
                format: depth_format(format)?,
                has_stencil: c.has_stencil != 0,
                is_reversed: c.is_depth_reversed != 0,
            }),
        },
        pass: match c.render_pass {
            0 => None,
            // SAFETY: the caller's promise.
            pass => Some(unsafe { HostPass::new(vk::RenderPass::from_raw(pass), c.subpass) }),
        },
    })
}

/// # Safety
/// As [`structure::array`].
pub(super) unsafe fn depth_images(
    pointer: *const sv_depth_image,
    count: u64,
) -> Result<Vec<HostDepthImage>, Failure> {
    let name = "depth_images";
    // SAFETY: the caller's promise.
    let images = unsafe { structure::array(name, pointer, count, MOST_FRAMES.into())? };
    let image = |c: &sv_depth_image| {
        if c.view == 0 {
            return Err(Failure::argument("sv_depth_image.view is 0"));
        }
        reserved("sv_depth_image.reserved", c.reserved)?;
        let view = vk::ImageView::from_raw(c.view);
        let layout = layout("sv_depth_image.layout", c.layout)?;
        // SAFETY: the caller's promise.
        Ok(unsafe { HostDepthImage::new(view, layout, [c.width, c.height]) })
    };
    images.iter().map(image).collect()
}

/// # Safety
/// As [`structure::read`].
pub(super) unsafe fn target(pointer: *const sv_target) -> Result<(Target, Load), Failure> {
    // SAFETY: the caller's promise.
    let c = unsafe { structure::read(pointer)? };
    for (name, handle) in [("image", c.image), ("view", c.view)] {
        if handle == 0 {
            return Err(Failure::argument(format!("sv_target.{name} is 0")));
        }
    }
    let color = c.clear_color.iter().find(|number| !number.is_finite());
    if let Some(&bad) = color.filter(|_| c.is_cleared != 0) {
        number("sv_target.clear_color", "finite numbers", bad.into(), false)?;
    }
    let target = Target {
        image: vk::Image::from_raw(c.image),
        view: vk::ImageView::from_raw(c.view),
        format: color_format("sv_target.format", c.format)?,
        extent: [c.width, c.height],
        before: state("sv_target.before", &c.before)?,
        after: match is_zero(&c.after) {
            true => Use::ColorTarget.into(),
            false => state("sv_target.after", &c.after)?,
        },
    };
    let load = match c.is_cleared {
        0 => Load::Keep,
        _ => Load::Clear(c.clear_color),
    };
    Ok((target, load))
}

fn is_zero(state: &sv_image_state) -> bool {
    (
        state.layout,
        state.has_queue_family,
        state.stage,
        state.access,
        state.reserved,
    ) == (0, 0, 0, 0, 0)
}

fn state(name: &str, c: &sv_image_state) -> Result<TargetState, Failure> {
    reserved(&format!("{name}.reserved"), c.reserved)?;
    Ok(TargetState {
        layout: layout(&format!("{name}.layout"), c.layout)?,
        stage: vk::PipelineStageFlags2::from_raw(c.stage),
        access: vk::AccessFlags2::from_raw(c.access),
        queue_family: match c.has_queue_family {
            0 => vk::QUEUE_FAMILY_IGNORED,
            _ => c.queue_family,
        },
    })
}

/// A layout that is one.
fn layout(name: &str, found: u32) -> Result<vk::ImageLayout, Failure> {
    // Of Vulkan 1.0 to 1.3, and VK_IMAGE_LAYOUT_PRESENT_SRC_KHR.
    let is_layout = matches!(
        found,
        0..=8
            | 1_000_117_000..=1_000_117_001
            | 1_000_241_000..=1_000_241_003
            | 1_000_314_000..=1_000_314_001
            | 1_000_001_002
    );
    let wanted = "a VkImageLayout of Vulkan 1.3 or VK_IMAGE_LAYOUT_PRESENT_SRC_KHR";
    number(name, wanted, found.into(), is_layout)?;
    Ok(vk::ImageLayout::from_raw(found as i32))
}

/// Drivers are not asked about numbers that are no format: some would look past the end of a table.
fn color_format(name: &str, format: u32) -> Result<vk::Format, Failure> {
    let is_format = (1..=184).contains(&format);
    let wanted = "a VkFormat of Vulkan 1.0 (1 to 184)";
    number(name, wanted, format.into(), is_format)?;
    Ok(vk::Format::from_raw(format as i32))
}

fn depth_format(format: u32) -> Result<vk::Format, Failure> {
    let name = "sv_target_class.depth_format";
    // VK_FORMAT_D16_UNORM to VK_FORMAT_D32_SFLOAT_S8_UINT, of which 127 is stencil alone.
    let is_depth = (124..=130).contains(&format) && format != 127;
    number(name, "a VkFormat with depth", format.into(), is_depth)?;
    Ok(vk::Format::from_raw(format as i32))
}
