//! Copies, bindings, submissions and answers that are changed on their way.
#![allow(non_snake_case, reason = "functions are named as Vulkan names them")]

use super::states::{State, state};
use super::{Function, behind, count, hooks, real};
use ash::vk;
use std::ffi::CStr;

/// What is handed out in place of a function, and its name for good.
pub fn hook(name: &CStr) -> Option<(&'static str, Function)> {
    hooks!(
        name,
        vkCmdCopyBufferToImage,
        vkCmdCopyImageToBuffer,
        vkCmdCopyBuffer,
        vkCmdFillBuffer,
        vkUpdateDescriptorSets,
        vkCmdBindDescriptorSets,
        vkQueueSubmit2,
        vkGetSemaphoreCounterValue
    )
}

unsafe extern "system" fn vkCmdCopyBufferToImage(
    cmd: vk::CommandBuffer,
    buffer: vk::Buffer,
    image: vk::Image,
    layout: vk::ImageLayout,
    number: u32,
    regions: *const vk::BufferImageCopy,
) {
    // SAFETY: the caller's arguments; the rows of the buffer stay as long as they are.
    unsafe {
        let mut copy = *regions;
        let whole = copy.image_extent;
        match state() {
            Some(State::LastColumnNotCopied) if whole.width > 1 => {
                copy.buffer_row_length = whole.width;
                copy.buffer_image_height = whole.height;
                copy.image_extent.width -= 1;
                count();
            }
            Some(State::LastSliceNotCopied) if whole.depth > 1 => {
                copy.image_extent.depth -= 1;
                count();
            }
            Some(State::LastSliceNotCopied) if copy.image_subresource.layer_count > 1 => {
                copy.image_subresource.layer_count -= 1;
                count();
            }
            _ => {}
        }
        behind!(vkCmdCopyBufferToImage:
            fn(vk::CommandBuffer, vk::Buffer, vk::Image, vk::ImageLayout, u32, *const vk::BufferImageCopy),
            (cmd, buffer, image, layout, number, &copy));
    }
}

unsafe extern "system" fn vkCmdCopyImageToBuffer(
    cmd: vk::CommandBuffer,
    image: vk::Image,
    layout: vk::ImageLayout,
    buffer: vk::Buffer,
    number: u32,
    regions: *const vk::BufferImageCopy,
) {
    // SAFETY: as above; a column less is read, from one texel further on.
    unsafe {
        let mut copy = *regions;
        let whole = copy.image_extent;
        if state() == Some(State::ReadbackOneTexelOff) && whole.width > 1 {
            copy.buffer_row_length = whole.width;
            copy.buffer_image_height = whole.height;
            copy.image_offset.x += 1;
            copy.image_extent.width -= 1;
            count();
        }
        behind!(vkCmdCopyImageToBuffer:
            fn(vk::CommandBuffer, vk::Image, vk::ImageLayout, vk::Buffer, u32, *const vk::BufferImageCopy),
            (cmd, image, layout, buffer, number, &copy));
    }
}

unsafe extern "system" fn vkCmdCopyBuffer(
    cmd: vk::CommandBuffer,
    from: vk::Buffer,
    to: vk::Buffer,
    number: u32,
    regions: *const vk::BufferCopy,
) {
    if state() == Some(State::BuffersNotCopied) {
        count();
        return;
    }
    // SAFETY: as above.
    unsafe {
        behind!(vkCmdCopyBuffer: fn(vk::CommandBuffer, vk::Buffer, vk::Buffer, u32, *const vk::BufferCopy), (cmd, from, to, number, regions));
    }
}

unsafe extern "system" fn vkUpdateDescriptorSets(
    device: vk::Device,
    writes: u32,
    infos: *const vk::WriteDescriptorSet<'static>,
    copies: u32,
    from: *const vk::CopyDescriptorSet<'static>,
) {
    // SAFETY: as above; what is changed are copies that live until the call is done. A device that does not look at
    // what is bound reads on where the memory does: the range ends inside of the allocation.
    unsafe {
        let mut infos = std::slice::from_raw_parts(infos, writes as usize).to_vec();
        let mut ranges = Vec::new();
        if let Some(State::RangeTimes(times)) = state() {
            for info in infos.iter().filter(|info| !info.p_buffer_info.is_null()) {
                let mut range = *info.p_buffer_info;
                if range.range != vk::WHOLE_SIZE {
                    range.range *= times;
                    count();
                }
                ranges.push([range]);
            }
            let buffers = infos
                .iter_mut()
                .filter(|info| !info.p_buffer_info.is_null());
            for (info, range) in buffers.zip(&ranges) {
                info.p_buffer_info = range.as_ptr();
            }
        }
        behind!(vkUpdateDescriptorSets:
            fn(vk::Device, u32, *const vk::WriteDescriptorSet<'static>, u32, *const vk::CopyDescriptorSet<'static>),
            (device, writes, infos.as_ptr(), copies, from));
    }
}

unsafe extern "system" fn vkCmdBindDescriptorSets(
    cmd: vk::CommandBuffer,
    point: vk::PipelineBindPoint,
    layout: vk::PipelineLayout,
    first: u32,
    number: u32,
    sets: *const vk::DescriptorSet,
    offsets: u32,
    offset: *const u32,
) {
    let zeros = vec![0; offsets as usize];
    let mut offset = offset;
    if state() == Some(State::DynamicOffsetsForgotten) && offsets > 0 {
        offset = zeros.as_ptr();
        count();
    }
    // SAFETY: as above.
    unsafe {
        behind!(vkCmdBindDescriptorSets:
            fn(vk::CommandBuffer, vk::PipelineBindPoint, vk::PipelineLayout, u32, u32, *const vk::DescriptorSet, u32, *const u32),
            (cmd, point, layout, first, number, sets, offsets, offset));
    }
}

unsafe extern "system" fn vkQueueSubmit2(
    queue: vk::Queue,
    number: u32,
    infos: *const vk::SubmitInfo2<'static>,
    fence: vk::Fence,
) -> vk::Result {
    // SAFETY: as above; without its semaphores a submission waits for nobody.
    unsafe {
        let mut infos = std::slice::from_raw_parts(infos, number as usize).to_vec();
        if state() == Some(State::SubmittedBackwards) && number > 1 {
            infos.reverse();
            for info in &mut infos {
                info.wait_semaphore_info_count = 0;
                info.signal_semaphore_info_count = 0;
            }
            count();
        }
        behind!(vkQueueSubmit2: fn(vk::Queue, u32, *const vk::SubmitInfo2<'static>, vk::Fence) -> vk::Result, (queue, number, infos.as_ptr(), fence))
    }
}

unsafe extern "system" fn vkCmdFillBuffer(
    cmd: vk::CommandBuffer,
    buffer: vk::Buffer,
    offset: vk::DeviceSize,
    size: vk::DeviceSize,
    word: u32,
) {
    let mut word = word;
    if let Some(State::FillsWith(other)) = state() {
        word = other;
        count();
    }
    // SAFETY: as above.
    unsafe {
        behind!(vkCmdFillBuffer: fn(vk::CommandBuffer, vk::Buffer, vk::DeviceSize, vk::DeviceSize, u32), (cmd, buffer, offset, size, word));
    }
}

unsafe extern "system" fn vkGetSemaphoreCounterValue(
    device: vk::Device,
    semaphore: vk::Semaphore,
    out: *mut u64,
) -> vk::Result {
    // SAFETY: as above.
    unsafe {
        let result = behind!(vkGetSemaphoreCounterValue: fn(vk::Device, vk::Semaphore, *mut u64) -> vk::Result, (device, semaphore, out));
        if state() == Some(State::CountersAhead) {
            *out += 1;
            count();
        }
        result
    }
}
