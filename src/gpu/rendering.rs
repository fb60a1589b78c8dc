//! Beginning and ending dynamic rendering to color targets.

use super::{Gpu, Tile};
use ash::vk;

/// What a color target holds when rendering begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    /// What was there.
    Keep,
    /// One color everywhere: red, green, blue, alpha.
    Clear([f32; 4]),
}

/// Begins rendering to `targets`, in order of location. Viewport and scissor are set by [`set_area`].
///
/// # Safety
///
/// - `cmd` is recording on `gpu`'s device, outside rendering;
/// - each view is of a color image of at least `extent`, in [`super::Use::ColorTarget`], and lives until `cmd` has
///   run.
pub unsafe fn begin_rendering<const N: usize>(
    gpu: &Gpu,
    cmd: vk::CommandBuffer,
    targets: &[(vk::ImageView, Load); N],
    extent: [u32; 2],
) {
    // SAFETY: the caller's promises.
    unsafe { begin_rendering_of(gpu, cmd, targets, Tile::whole(extent)) };
}

/// The same to a part of the targets: what lies outside stays as it is, cleared or not.
///
/// # Safety
///
/// As [`begin_rendering`]; the images are as large as the tile reaches.
pub unsafe fn begin_rendering_of<const N: usize>(
    gpu: &Gpu,
    cmd: vk::CommandBuffer,
    targets: &[(vk::ImageView, Load); N],
    tile: Tile,
) {
    // SAFETY: the caller's promises.
    unsafe { begin_rendering_behind(gpu, cmd, targets, None, tile) };
}

/// The same with a depth attachment: its view and the depth that all of the tile has at first. What it holds afterwards
/// is of no use.
///
/// # Safety
///
/// As [`begin_rendering_of`], also of that image, which is in [`super::Use::DepthTarget`].
pub unsafe fn begin_rendering_behind<const N: usize>(
    gpu: &Gpu,
    cmd: vk::CommandBuffer,
    targets: &[(vk::ImageView, Load); N],
    depth: Option<(vk::ImageView, f32)>,
    tile: Tile,
) {
    let attachments = targets.map(|(view, load)| attachment(view, load));
    let info = vk::RenderingInfo::default()
        .render_area(area(tile))
        .layer_count(1)
        .color_attachments(&attachments);
    let depth_attachment = depth.map(|(view, depth)| {
        let depth_stencil = vk::ClearDepthStencilValue { depth, stencil: 0 };
        vk::RenderingAttachmentInfo::default()
            .image_view(view)
            .image_layout(vk::ImageLayout::DEPTH_ATTACHMENT_OPTIMAL)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::DONT_CARE)
            .clear_value(vk::ClearValue { depth_stencil })
    });
    let info = match &depth_attachment {
        Some(attachment) => info.depth_attachment(attachment),
        None => info,
    };
    // SAFETY: the caller's promises; dynamicRendering was required of the device.
    gpu.record(|device| unsafe { device.cmd_begin_rendering(cmd, &info) });
}

/// Sets viewport and scissor to all of `extent`.
///
/// # Safety
///
/// `cmd` is recording on `gpu`'s device.
pub unsafe fn set_area(gpu: &Gpu, cmd: vk::CommandBuffer, extent: [u32; 2]) {
    // SAFETY: the caller's promise.
    unsafe { set_area_of(gpu, cmd, extent, Tile::whole(extent)) };
}

/// Sets the viewport to all of `extent` and the scissor to a part of it.
///
/// # Safety
///
/// As [`set_area`].
pub unsafe fn set_area_of(gpu: &Gpu, cmd: vk::CommandBuffer, extent: [u32; 2], tile: Tile) {
    // The viewport may be larger than what is drawn into, the scissor not.
    let viewport = vk::Viewport {
        x: 0.0,
        y: 0.0,
        width: extent[0] as f32,
        height: extent[1] as f32,
        min_depth: 0.0,
        max_depth: 1.0,
    };
    // SAFETY: the caller's promise.
    gpu.record(|device| unsafe {
        device.cmd_set_viewport(cmd, 0, &[viewport]);
        device.cmd_set_scissor(cmd, 0, &[area(tile)]);
    });
}

/// The coordinates of a picture are far under 2^31.
fn area(tile: Tile) -> vk::Rect2D {
    let ([x, y], [width, height]) = (tile.origin.map(|n| n as i32), tile.extent);
    vk::Rect2D {
        offset: vk::Offset2D { x, y },
        extent: vk::Extent2D { width, height },
    }
}

/// Ends what [`begin_rendering`] began.
///
/// # Safety
///
/// `cmd` is recording on `gpu`'s device, inside that rendering.
pub unsafe fn end_rendering(gpu: &Gpu, cmd: vk::CommandBuffer) {
    // SAFETY: the caller's promise.
    gpu.record(|device| unsafe { device.cmd_end_rendering(cmd) });
}

fn attachment<'a>(view: vk::ImageView, load: Load) -> vk::RenderingAttachmentInfo<'a> {
    let (op, color) = match load {
        Load::Keep => (vk::AttachmentLoadOp::LOAD, [0.0; 4]),
        Load::Clear(color) => (vk::AttachmentLoadOp::CLEAR, color),
    };
    vk::RenderingAttachmentInfo::default()
        .image_view(view)
        .image_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
        .load_op(op)
        .store_op(vk::AttachmentStoreOp::STORE)
        .clear_value(vk::ClearValue {
            color: vk::ClearColorValue { float32: color },
        })
}
