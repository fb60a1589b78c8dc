//! Calls whose arguments are changed on their way to the driver.
#![allow(non_snake_case, reason = "functions are named as Vulkan names them")]

use super::{Fault, Function, behind, count, fault, hooks, real};
use ash::vk;
use std::ffi::CStr;
use vk::{BlendFactor as Factor, BlendOp as Op};

type Alloc = *const vk::AllocationCallbacks<'static>;

/// What is changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum State {
    /// This factor of colours and alphas is that one.
    Factor(Factor, Factor),
    /// The alphas' factor of what is there is that one.
    AlphaFactor(Factor, Factor),
    BlendOp(Op, Op),
    NoBlending,
    ColorsOnly,
    Cull(vk::CullModeFlags),
    /// Added to x, y, width and height of viewports.
    Viewport([f32; 4]),
    UpsideDown,
    ScissorNarrower,
    LastInstanceDropped,
    FirstInstanceDropped,
    LastTriangleDropped,
    DrawnTwice,
    LastGroupDropped(usize),
    Address(vk::SamplerAddressMode),
    SampledBy(vk::Filter, vk::Filter),
    LastColumnNotCopied,
    LastSliceNotCopied,
    ReadbackOneTexelOff,
    ClearedTo(f32),
    FillsWith(u32),
    CountersAhead,
    /// This operator of depth is that one.
    Compare(vk::CompareOp, vk::CompareOp),
    NoDepthWrites,
    NoDepthTest,
    DepthClamped,
    DepthRangeForgotten,
    DepthClearedTo(f32),
    BuffersNotCopied,
    /// What is bound of a buffer reaches so many times as far.
    RangeTimes(u64),
    DynamicOffsetsForgotten,
    SubmittedBackwards,
}

pub fn state() -> Option<State> {
    match fault() {
        Some(Fault::State(state)) => Some(state),
        _ => None,
    }
}

/// What is handed out in place of a function, and its name for good.
pub fn hook(name: &CStr) -> Option<(&'static str, Function)> {
    hooks!(
        name,
        vkCreateGraphicsPipelines,
        vkCreateSampler,
        vkCmdSetViewport,
        vkCmdSetScissor,
        vkCmdDraw,
        vkCmdDispatch,
        vkCmdBeginRendering
    )
}

unsafe extern "system" fn vkCreateGraphicsPipelines(
    device: vk::Device,
    cache: vk::PipelineCache,
    number: u32,
    infos: *const vk::GraphicsPipelineCreateInfo<'static>,
    alloc: Alloc,
    out: *mut vk::Pipeline,
) -> vk::Result {
    // SAFETY: the caller's arguments; what is changed are copies that live until the call is done.
    unsafe {
        let mut info = *infos;
        let mut blend = *info.p_color_blend_state;
        let mut raster = *info.p_rasterization_state;
        let mut attachment = *blend.p_attachments;
        let before = attachment;
        match state() {
            Some(State::Factor(from, to)) => {
                for factor in [
                    &mut attachment.src_color_blend_factor,
                    &mut attachment.dst_color_blend_factor,
                    &mut attachment.src_alpha_blend_factor,
                    &mut attachment.dst_alpha_blend_factor,
                ] {
                    if *factor == from {
                        *factor = to;
                    }
                }
            }
            Some(State::AlphaFactor(from, to)) if attachment.dst_alpha_blend_factor == from => {
                attachment.dst_alpha_blend_factor = to;
            }
            Some(State::BlendOp(from, to)) if attachment.color_blend_op == from => {
                attachment.color_blend_op = to;
                attachment.alpha_blend_op = to;
            }
            Some(State::NoBlending) => attachment.blend_enable = vk::FALSE,
            Some(State::ColorsOnly) => {
                attachment.color_write_mask &= !vk::ColorComponentFlags::A;
            }
            Some(State::Cull(mode)) => {
                raster.cull_mode = mode;
                count();
            }
            Some(State::DepthClamped) => {
                raster.depth_clamp_enable = vk::TRUE;
                count();
            }
            _ => {}
        }
        let mut depth = info.p_depth_stencil_state.as_ref().copied();
        if let Some(depth) = &mut depth {
            change_depth(depth);
            info.p_depth_stencil_state = depth;
        }
        let changes = |a: vk::PipelineColorBlendAttachmentState| {
            (
                a.blend_enable,
                a.src_color_blend_factor,
                a.dst_color_blend_factor,
                a.dst_alpha_blend_factor,
                a.color_blend_op,
                a.color_write_mask,
            )
        };
        if changes(before) != changes(attachment) {
            count();
        }
        blend.p_attachments = &attachment;
        info.p_color_blend_state = &blend;
        info.p_rasterization_state = &raster;
        behind!(vkCreateGraphicsPipelines:
            fn(vk::Device, vk::PipelineCache, u32, *const vk::GraphicsPipelineCreateInfo<'static>, Alloc, *mut vk::Pipeline) -> vk::Result,
            (device, cache, number, &info, alloc, out))
    }
}

fn change_depth(depth: &mut vk::PipelineDepthStencilStateCreateInfo<'_>) {
    match state() {
        Some(State::Compare(from, to)) if depth.depth_compare_op == from => {
            depth.depth_compare_op = to;
            count();
        }
        Some(State::NoDepthWrites) => {
            depth.depth_write_enable = vk::FALSE;
            count();
        }
        Some(State::NoDepthTest) => {
            depth.depth_test_enable = vk::FALSE;
            count();
        }
        _ => {}
    }
}

unsafe extern "system" fn vkCreateSampler(
    device: vk::Device,
    info: *const vk::SamplerCreateInfo<'static>,
    alloc: Alloc,
    out: *mut vk::Sampler,
) -> vk::Result {
    // SAFETY: as above.
    unsafe {
        let mut info = *info;
        match state() {
            Some(State::Address(mode)) => {
                (
                    info.address_mode_u,
                    info.address_mode_v,
                    info.address_mode_w,
                ) = (mode, mode, mode);
                count();
            }
            Some(State::SampledBy(from, to)) if info.mag_filter == from => {
                (info.mag_filter, info.min_filter) = (to, to);
                count();
            }
            _ => {}
        }
        behind!(vkCreateSampler:
            fn(vk::Device, *const vk::SamplerCreateInfo<'static>, Alloc, *mut vk::Sampler) -> vk::Result,
            (device, &info, alloc, out))
    }
}

unsafe extern "system" fn vkCmdSetViewport(
    cmd: vk::CommandBuffer,
    first: u32,
    number: u32,
    viewports: *const vk::Viewport,
) {
    // SAFETY: as above.
    unsafe {
        let mut viewport = *viewports;
        match state() {
            Some(State::Viewport([x, y, width, height])) => {
                viewport.x += x;
                viewport.y += y;
                viewport.width += width;
                viewport.height += height;
                count();
            }
            Some(State::DepthRangeForgotten) => {
                (viewport.min_depth, viewport.max_depth) = (0.0, 1.0);
                count();
            }
            Some(State::UpsideDown) => {
                viewport.y += viewport.height;
                viewport.height = -viewport.height;
                count();
            }
            _ => {}
        }
        behind!(vkCmdSetViewport: fn(vk::CommandBuffer, u32, u32, *const vk::Viewport), (cmd, first, number, &viewport));
    }
}

unsafe extern "system" fn vkCmdSetScissor(
    cmd: vk::CommandBuffer,
    first: u32,
    number: u32,
    scissors: *const vk::Rect2D,
) {
    // SAFETY: as above.
    unsafe {
        let mut scissor = *scissors;
        if state() == Some(State::ScissorNarrower) {
            scissor.extent.width -= 1;
            count();
        }
        behind!(vkCmdSetScissor: fn(vk::CommandBuffer, u32, u32, *const vk::Rect2D), (cmd, first, number, &scissor));
    }
}

unsafe extern "system" fn vkCmdDraw(
    cmd: vk::CommandBuffer,
    vertices: u32,
    instances: u32,
    vertex: u32,
    instance: u32,
) {
    let asked = (vertices, instances, 1);
    let (mut vertices, mut instances, mut times) = asked;
    let mut instance = instance;
    match state() {
        Some(State::LastInstanceDropped) if instances > 1 => instances -= 1,
        Some(State::FirstInstanceDropped) if instances > 1 => {
            instances -= 1;
            instance += 1;
        }
        Some(State::LastTriangleDropped) if vertices > 3 => vertices -= 3,
        Some(State::DrawnTwice) => times = 2,
        _ => {}
    }
    if (vertices, instances, times) != asked {
        count();
    }
    for _ in 0..times {
        // SAFETY: as above; fewer of what there is.
        unsafe {
            behind!(vkCmdDraw: fn(vk::CommandBuffer, u32, u32, u32, u32), (cmd, vertices, instances, vertex, instance));
        }
    }
}

unsafe extern "system" fn vkCmdDispatch(cmd: vk::CommandBuffer, x: u32, y: u32, z: u32) {
    let mut groups = [x, y, z];
    if let Some(State::LastGroupDropped(axis)) = state()
        && groups[axis] > 1
    {
        groups[axis] -= 1;
        count();
    }
    let [x, y, z] = groups;
    // SAFETY: as above.
    unsafe { behind!(vkCmdDispatch: fn(vk::CommandBuffer, u32, u32, u32), (cmd, x, y, z)) };
}

unsafe extern "system" fn vkCmdBeginRendering(
    cmd: vk::CommandBuffer,
    info: *const vk::RenderingInfo<'static>,
) {
    // SAFETY: as above.
    unsafe {
        let mut info = *info;
        let count_of = info.color_attachment_count as usize;
        let mut attachments = match count_of {
            0 => Vec::new(),
            _ => std::slice::from_raw_parts(info.p_color_attachments, count_of).to_vec(),
        };
        if let Some(State::ClearedTo(number)) = state() {
            for attachment in &mut attachments {
                attachment.clear_value.color.float32 = [number; 4];
                count();
            }
        }
        info.p_color_attachments = attachments.as_ptr();
        let mut depth = info.p_depth_attachment.as_ref().copied();
        if let (Some(depth), Some(State::DepthClearedTo(z))) = (&mut depth, state()) {
            depth.clear_value.depth_stencil.depth = z;
            info.p_depth_attachment = depth;
            count();
        }
        behind!(vkCmdBeginRendering: fn(vk::CommandBuffer, *const vk::RenderingInfo<'static>), (cmd, &info));
    }
}
