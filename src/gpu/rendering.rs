//! Beginning and ending dynamic rendering to color targets.

use super::Gpu;
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
pub unsafe fn begin_rendering(
    gpu: &Gpu,
    cmd: vk::CommandBuffer,
    targets: &[(vk::ImageView, Load)],
    extent: [u32; 2],
) {
    let attachments: Vec<_> = targets
        .iter()
        .map(|&(view, load)| attachment(view, load))
        .collect();
    let info = vk::RenderingInfo::default()
        .render_area(area(extent))
        .layer_count(1)
        .color_attachments(&attachments);
    // SAFETY: the caller's promises; dynamicRendering was required of the device.
    unsafe { gpu.device().cmd_begin_rendering(cmd, &info) };
}

/// Sets viewport and scissor to all of `extent`.
///
/// # Safety
///
/// `cmd` is recording on `gpu`'s device.
pub unsafe fn set_area(gpu: &Gpu, cmd: vk::CommandBuffer, extent: [u32; 2]) {
    let viewport = vk::Viewport {
        x: 0.0,
        y: 0.0,
        width: extent[0] as f32,
        height: extent[1] as f32,
        min_depth: 0.0,
        max_depth: 1.0,
    };
    // SAFETY: the caller's promise.
    unsafe {
        gpu.device().cmd_set_viewport(cmd, 0, &[viewport]);
        gpu.device().cmd_set_scissor(cmd, 0, &[area(extent)]);
    }
}

fn area([width, height]: [u32; 2]) -> vk::Rect2D {
    vk::Rect2D {
        offset: vk::Offset2D::default(),
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
    unsafe { gpu.device().cmd_end_rendering(cmd) };
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
