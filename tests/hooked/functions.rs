//! The Vulkan functions that stratavox calls, each behind one of the same signature that is counted, may be told to
//! fail, and keeps the books of what was made and destroyed. A function that is not here is not handed out: calling it
//! ends the process with its name.
#![allow(non_snake_case, reason = "functions are named as Vulkan names them")]
#![allow(
    unused_unsafe,
    reason = "not all that is noted after a call looks at what it wrote"
)]

use super::{enter, gone, lacking, made, real_of};
use ash::vk;
use std::ffi::{c_char, c_void};

type Alloc = *const vk::AllocationCallbacks<'static>;
type Function = unsafe extern "system" fn();

macro_rules! fallible {
    ($($name:ident($($arg:ident: $type:ty),*) $(=> $then:block)?;)*) => {
        $(unsafe extern "system" fn $name($($arg: $type),*) -> vk::Result {
            if let Some(result) = enter(stringify!($name)) {
                return result;
            }
            // SAFETY: this is the function of that name, and the caller's arguments are handed on.
            let result = unsafe {
                type Real = unsafe extern "system" fn($($type),*) -> vk::Result;
                std::mem::transmute::<usize, Real>(real_of(stringify!($name)))($($arg),*)
            };
            $(if result == vk::Result::SUCCESS {
                // SAFETY: outputs are valid where the call has succeeded.
                unsafe { $then }
            })?
            result
        })*

        /// Those that return a `VkResult`.
        pub const FALLIBLE: &[&str] = &[$(stringify!($name)),*];

        fn fallible(name: &str) -> Option<(&'static str, Function)> {
            match name {
                $(stringify!($name) => {
                    type Hook = unsafe extern "system" fn($($type),*) -> vk::Result;
                    // SAFETY: `vkGetInstanceProcAddr` gives functions of every type as this one.
                    let hook = unsafe { std::mem::transmute::<Hook, Function>($name) };
                    Some((stringify!($name), hook))
                })*
                _ => None,
            }
        }
    };
}

macro_rules! others {
    ($($name:ident($($arg:ident: $type:ty),*) $(=> $then:block)?;)*) => {
        $(unsafe extern "system" fn $name($($arg: $type),*) {
            let _ = enter(stringify!($name));
            // SAFETY: this is the function of that name, and the caller's arguments are handed on.
            unsafe {
                type Real = unsafe extern "system" fn($($type),*);
                std::mem::transmute::<usize, Real>(real_of(stringify!($name)))($($arg),*);
            }
            $({
                // SAFETY: outputs are valid after the call.
                unsafe { $then }
            })?
        })*

        fn other(name: &str) -> Option<(&'static str, Function)> {
            match name {
                $(stringify!($name) => {
                    type Hook = unsafe extern "system" fn($($type),*);
                    // SAFETY: as above.
                    let hook = unsafe { std::mem::transmute::<Hook, Function>($name) };
                    Some((stringify!($name), hook))
                })*
                _ => None,
            }
        }
    };
}

/// What is handed out in place of a function, and its name for good.
pub fn hook(name: &str) -> Option<(&'static str, Function)> {
    fallible(name).or_else(|| other(name))
}

fallible! {
    vkCreateInstance(info: *const vk::InstanceCreateInfo<'_>, alloc: Alloc, out: *mut vk::Instance)
        => { made("instance", *out) };
    vkEnumerateInstanceVersion(version: *mut u32);
    vkEnumerateInstanceExtensionProperties(
        layer: *const c_char, count: *mut u32, out: *mut vk::ExtensionProperties);
    vkEnumeratePhysicalDevices(instance: vk::Instance, count: *mut u32, out: *mut vk::PhysicalDevice);
    vkEnumerateDeviceExtensionProperties(
        device: vk::PhysicalDevice, layer: *const c_char, count: *mut u32,
        out: *mut vk::ExtensionProperties)
        => {
            // Without names, and not fewer: who has no room for all of them is asked again.
            if !out.is_null() && lacking().device_extensions {
                let extensions = std::slice::from_raw_parts_mut(out, *count as usize);
                extensions.iter_mut().for_each(|one| one.extension_name = [0; 256]);
            }
            // In the place of another, for the same reason.
            if !out.is_null() && lacking().parts {
                let name = ash::khr::portability_subset::NAME.to_bytes();
                let to = (*out).extension_name.iter_mut();
                to.zip(name.iter().chain(&[0])).for_each(|(to, from)| *to = *from as c_char);
            }
        };
    vkGetPhysicalDeviceImageFormatProperties2(
        device: vk::PhysicalDevice, info: *const vk::PhysicalDeviceImageFormatInfo2<'_>,
        out: *mut vk::ImageFormatProperties2<'_>);
    vkCreateDevice(
        physical: vk::PhysicalDevice, info: *const vk::DeviceCreateInfo<'_>, alloc: Alloc,
        out: *mut vk::Device) => { made("device", *out) };
    vkSetDebugUtilsObjectNameEXT(device: vk::Device, info: *const vk::DebugUtilsObjectNameInfoEXT<'_>);
    vkCreatePipelineCache(
        device: vk::Device, info: *const vk::PipelineCacheCreateInfo<'_>, alloc: Alloc,
        out: *mut vk::PipelineCache) => { made("pipeline cache", *out) };
    vkGetPipelineCacheData(
        device: vk::Device, cache: vk::PipelineCache, size: *mut usize, out: *mut c_void);
    vkCreateBuffer(
        device: vk::Device, info: *const vk::BufferCreateInfo<'_>, alloc: Alloc, out: *mut vk::Buffer)
        => { made("buffer", *out) };
    vkBindBufferMemory(
        device: vk::Device, buffer: vk::Buffer, memory: vk::DeviceMemory, offset: vk::DeviceSize);
    vkCreateImage(
        device: vk::Device, info: *const vk::ImageCreateInfo<'_>, alloc: Alloc, out: *mut vk::Image)
        => { made("image", *out) };
    vkBindImageMemory(
        device: vk::Device, image: vk::Image, memory: vk::DeviceMemory, offset: vk::DeviceSize);
    vkCreateImageView(
        device: vk::Device, info: *const vk::ImageViewCreateInfo<'_>, alloc: Alloc,
        out: *mut vk::ImageView) => { made("image view", *out) };
    vkAllocateMemory(
        device: vk::Device, info: *const vk::MemoryAllocateInfo<'_>, alloc: Alloc,
        out: *mut vk::DeviceMemory) => { made("memory", *out) };
    vkMapMemory(
        device: vk::Device, memory: vk::DeviceMemory, offset: vk::DeviceSize, size: vk::DeviceSize,
        flags: vk::MemoryMapFlags, out: *mut *mut c_void);
    vkCreateSampler(
        device: vk::Device, info: *const vk::SamplerCreateInfo<'_>, alloc: Alloc,
        out: *mut vk::Sampler) => { made("sampler", *out) };
    vkCreateDescriptorSetLayout(
        device: vk::Device, info: *const vk::DescriptorSetLayoutCreateInfo<'_>, alloc: Alloc,
        out: *mut vk::DescriptorSetLayout) => { made("set layout", *out) };
    vkCreatePipelineLayout(
        device: vk::Device, info: *const vk::PipelineLayoutCreateInfo<'_>, alloc: Alloc,
        out: *mut vk::PipelineLayout) => { made("pipeline layout", *out) };
    vkCreateShaderModule(
        device: vk::Device, info: *const vk::ShaderModuleCreateInfo<'_>, alloc: Alloc,
        out: *mut vk::ShaderModule) => { made("shader module", *out) };
    vkCreateComputePipelines(
        device: vk::Device, cache: vk::PipelineCache, count: u32,
        infos: *const vk::ComputePipelineCreateInfo<'_>, alloc: Alloc, out: *mut vk::Pipeline)
        => { (0..count as usize).for_each(|k| made("pipeline", *out.add(k))) };
    vkCreateGraphicsPipelines(
        device: vk::Device, cache: vk::PipelineCache, count: u32,
        infos: *const vk::GraphicsPipelineCreateInfo<'_>, alloc: Alloc, out: *mut vk::Pipeline)
        => { (0..count as usize).for_each(|k| made("pipeline", *out.add(k))) };
    vkCreateDescriptorPool(
        device: vk::Device, info: *const vk::DescriptorPoolCreateInfo<'_>, alloc: Alloc,
        out: *mut vk::DescriptorPool) => { made("descriptor pool", *out) };
    vkAllocateDescriptorSets(
        device: vk::Device, info: *const vk::DescriptorSetAllocateInfo<'_>,
        out: *mut vk::DescriptorSet);
    vkFreeDescriptorSets(
        device: vk::Device, pool: vk::DescriptorPool, count: u32, sets: *const vk::DescriptorSet);
    vkCreateQueryPool(
        device: vk::Device, info: *const vk::QueryPoolCreateInfo<'_>, alloc: Alloc,
        out: *mut vk::QueryPool) => { made("query pool", *out) };
    vkGetQueryPoolResults(
        device: vk::Device, pool: vk::QueryPool, first: u32, count: u32, size: usize,
        out: *mut c_void, stride: vk::DeviceSize, flags: vk::QueryResultFlags);
    vkCreateCommandPool(
        device: vk::Device, info: *const vk::CommandPoolCreateInfo<'_>, alloc: Alloc,
        out: *mut vk::CommandPool) => { made("command pool", *out) };
    vkAllocateCommandBuffers(
        device: vk::Device, info: *const vk::CommandBufferAllocateInfo<'_>,
        out: *mut vk::CommandBuffer);
    vkCreateFence(
        device: vk::Device, info: *const vk::FenceCreateInfo<'_>, alloc: Alloc, out: *mut vk::Fence)
        => { made("fence", *out) };
    vkResetCommandPool(device: vk::Device, pool: vk::CommandPool, flags: vk::CommandPoolResetFlags);
    vkBeginCommandBuffer(cmd: vk::CommandBuffer, info: *const vk::CommandBufferBeginInfo<'_>);
    vkEndCommandBuffer(cmd: vk::CommandBuffer);
    vkResetFences(device: vk::Device, count: u32, fences: *const vk::Fence);
    vkQueueSubmit(
        queue: vk::Queue, count: u32, submits: *const vk::SubmitInfo<'_>, fence: vk::Fence);
    vkQueueSubmit2(
        queue: vk::Queue, count: u32, submits: *const vk::SubmitInfo2<'_>, fence: vk::Fence);
    vkWaitForFences(
        device: vk::Device, count: u32, fences: *const vk::Fence, all: vk::Bool32, timeout: u64);
    vkDeviceWaitIdle(device: vk::Device);
}

others! {
    vkDestroyInstance(instance: vk::Instance, alloc: Alloc) => { gone("instance", instance) };
    vkDestroyDevice(device: vk::Device, alloc: Alloc) => { gone("device", device) };
    vkDestroyPipelineCache(device: vk::Device, cache: vk::PipelineCache, alloc: Alloc)
        => { gone("pipeline cache", cache) };
    vkDestroyBuffer(device: vk::Device, it: vk::Buffer, alloc: Alloc) => { gone("buffer", it) };
    vkDestroyImage(device: vk::Device, it: vk::Image, alloc: Alloc) => { gone("image", it) };
    vkDestroyImageView(device: vk::Device, it: vk::ImageView, alloc: Alloc) => { gone("image view", it) };
    vkFreeMemory(device: vk::Device, it: vk::DeviceMemory, alloc: Alloc) => { gone("memory", it) };
    vkDestroySampler(device: vk::Device, it: vk::Sampler, alloc: Alloc) => { gone("sampler", it) };
    vkDestroyDescriptorSetLayout(device: vk::Device, it: vk::DescriptorSetLayout, alloc: Alloc)
        => { gone("set layout", it) };
    vkDestroyPipelineLayout(device: vk::Device, it: vk::PipelineLayout, alloc: Alloc)
        => { gone("pipeline layout", it) };
    vkDestroyShaderModule(device: vk::Device, it: vk::ShaderModule, alloc: Alloc)
        => { gone("shader module", it) };
    vkDestroyPipeline(device: vk::Device, it: vk::Pipeline, alloc: Alloc) => { gone("pipeline", it) };
    vkDestroyDescriptorPool(device: vk::Device, it: vk::DescriptorPool, alloc: Alloc)
        => { gone("descriptor pool", it) };
    vkDestroyQueryPool(device: vk::Device, it: vk::QueryPool, alloc: Alloc) => { gone("query pool", it) };
    vkDestroyCommandPool(device: vk::Device, it: vk::CommandPool, alloc: Alloc)
        => { gone("command pool", it) };
    vkDestroyFence(device: vk::Device, it: vk::Fence, alloc: Alloc) => { gone("fence", it) };
    vkUnmapMemory(device: vk::Device, memory: vk::DeviceMemory);

    vkGetPhysicalDeviceProperties(device: vk::PhysicalDevice, out: *mut vk::PhysicalDeviceProperties);
    vkGetPhysicalDeviceProperties2(
        device: vk::PhysicalDevice, out: *mut vk::PhysicalDeviceProperties2<'_>);
    vkGetPhysicalDeviceFeatures(device: vk::PhysicalDevice, out: *mut vk::PhysicalDeviceFeatures);
    vkGetPhysicalDeviceFeatures2(device: vk::PhysicalDevice, out: *mut vk::PhysicalDeviceFeatures2<'_>);
    vkGetPhysicalDeviceMemoryProperties(
        device: vk::PhysicalDevice, out: *mut vk::PhysicalDeviceMemoryProperties);
    vkGetPhysicalDeviceQueueFamilyProperties(
        device: vk::PhysicalDevice, count: *mut u32, out: *mut vk::QueueFamilyProperties)
        => {
            if !out.is_null() && lacking().timestamps {
                let families = std::slice::from_raw_parts_mut(out, *count as usize);
                families.iter_mut().for_each(|family| family.timestamp_valid_bits = 0);
            }
        };
    vkGetPhysicalDeviceFormatProperties(
        device: vk::PhysicalDevice, format: vk::Format, out: *mut vk::FormatProperties)
        => {
            let (lacks, features) = lacking().format;
            if lacks == format {
                (*out).optimal_tiling_features &= !features;
            }
        };
    vkGetDeviceQueue(device: vk::Device, family: u32, index: u32, out: *mut vk::Queue);
    vkGetBufferMemoryRequirements(
        device: vk::Device, buffer: vk::Buffer, out: *mut vk::MemoryRequirements);
    vkGetImageMemoryRequirements(
        device: vk::Device, image: vk::Image, out: *mut vk::MemoryRequirements);
    vkGetImageSubresourceLayout(
        device: vk::Device, image: vk::Image, part: *const vk::ImageSubresource,
        out: *mut vk::SubresourceLayout);
    vkUpdateDescriptorSets(
        device: vk::Device, writes: u32, write: *const vk::WriteDescriptorSet<'_>, copies: u32,
        copy: *const vk::CopyDescriptorSet<'_>);
    vkCmdPipelineBarrier2(cmd: vk::CommandBuffer, info: *const vk::DependencyInfo<'_>);
    vkCmdBindPipeline(cmd: vk::CommandBuffer, point: vk::PipelineBindPoint, pipeline: vk::Pipeline);
    vkCmdBindDescriptorSets(
        cmd: vk::CommandBuffer, point: vk::PipelineBindPoint, layout: vk::PipelineLayout, first: u32,
        sets: u32, set: *const vk::DescriptorSet, offsets: u32, offset: *const u32);
    vkCmdDispatch(cmd: vk::CommandBuffer, x: u32, y: u32, z: u32);
    vkCmdDispatchIndirect(cmd: vk::CommandBuffer, buffer: vk::Buffer, offset: vk::DeviceSize);
    vkCmdDispatchBase(
        cmd: vk::CommandBuffer, x: u32, y: u32, z: u32, count_x: u32, count_y: u32, count_z: u32);
    vkCmdDraw(cmd: vk::CommandBuffer, vertices: u32, instances: u32, vertex: u32, instance: u32);
    vkCmdDrawIndirect(
        cmd: vk::CommandBuffer, buffer: vk::Buffer, offset: vk::DeviceSize, count: u32, stride: u32);
    vkCmdBeginRendering(cmd: vk::CommandBuffer, info: *const vk::RenderingInfo<'_>);
    vkCmdEndRendering(cmd: vk::CommandBuffer);
    vkCmdSetViewport(cmd: vk::CommandBuffer, first: u32, count: u32, viewports: *const vk::Viewport);
    vkCmdSetScissor(cmd: vk::CommandBuffer, first: u32, count: u32, scissors: *const vk::Rect2D);
    vkCmdCopyBufferToImage(
        cmd: vk::CommandBuffer, buffer: vk::Buffer, image: vk::Image, layout: vk::ImageLayout,
        count: u32, regions: *const vk::BufferImageCopy);
    vkCmdCopyImageToBuffer(
        cmd: vk::CommandBuffer, image: vk::Image, layout: vk::ImageLayout, buffer: vk::Buffer,
        count: u32, regions: *const vk::BufferImageCopy);
    vkCmdClearColorImage(
        cmd: vk::CommandBuffer, image: vk::Image, layout: vk::ImageLayout,
        color: *const vk::ClearColorValue, count: u32, ranges: *const vk::ImageSubresourceRange);
    vkCmdResetQueryPool(cmd: vk::CommandBuffer, pool: vk::QueryPool, first: u32, count: u32);
    vkCmdWriteTimestamp2(
        cmd: vk::CommandBuffer, stage: vk::PipelineStageFlags2, pool: vk::QueryPool, query: u32);
    vkCmdFillBuffer(
        cmd: vk::CommandBuffer, buffer: vk::Buffer, offset: vk::DeviceSize, size: vk::DeviceSize,
        word: u32);
    vkCmdCopyBuffer(
        cmd: vk::CommandBuffer, from: vk::Buffer, to: vk::Buffer, count: u32,
        regions: *const vk::BufferCopy);
}
