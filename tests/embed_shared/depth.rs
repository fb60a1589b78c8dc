//! A depth buffer of the host's, filled with numbers of ours, and the way back to the CPU.

use super::Host;
use super::image::allocate;
use ash::vk;
use std::ptr::copy_nonoverlapping;

/// One number a pixel.
pub struct DepthImage<'h> {
    pub raw: vk::Image,
    pub view: vk::ImageView,
    pub extent: [u32; 2],
    format: vk::Format,
    memory: vk::DeviceMemory,
    buffer: vk::Buffer,
    buffer_memory: vk::DeviceMemory,
    host: &'h Host,
}

const WHOLE: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::DEPTH,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: 1,
};

type State = (vk::PipelineStageFlags, vk::AccessFlags, vk::ImageLayout);

const COPIED_TO: State = (
    vk::PipelineStageFlags::TRANSFER,
    vk::AccessFlags::TRANSFER_WRITE,
    vk::ImageLayout::TRANSFER_DST_OPTIMAL,
);
const COPIED_FROM: State = (
    vk::PipelineStageFlags::TRANSFER,
    vk::AccessFlags::TRANSFER_READ,
    vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
);

/// What shaders read: rays in compute, slices in fragments.
pub const READ: State = (
    vk::PipelineStageFlags::from_raw(
        vk::PipelineStageFlags::COMPUTE_SHADER.as_raw()
            | vk::PipelineStageFlags::FRAGMENT_SHADER.as_raw(),
    ),
    vk::AccessFlags::SHADER_READ,
    vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
);
/// What is tested and written.
pub const ATTACHED: State = (
    vk::PipelineStageFlags::from_raw(
        vk::PipelineStageFlags::EARLY_FRAGMENT_TESTS.as_raw()
            | vk::PipelineStageFlags::LATE_FRAGMENT_TESTS.as_raw(),
    ),
    vk::AccessFlags::from_raw(
        vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_READ.as_raw()
            | vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
    ),
    vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
);

impl<'h> DepthImage<'h> {
    /// Of so many numbers as `D32_SFLOAT`, and brought to `state`.
    pub fn new(host: &'h Host, extent: [u32; 2], depths: &[f32], state: State) -> Self {
        Self::of_format(host, vk::Format::D32_SFLOAT, extent, depths, state)
    }

    /// The same in 16 or 24 bits.
    pub fn of_format(
        host: &'h Host,
        format: vk::Format,
        extent: [u32; 2],
        depths: &[f32],
        state: State,
    ) -> Self {
        assert_eq!(depths.len(), (extent[0] * extent[1]) as usize);
        let made = Self::of_samples(host, format, extent, vk::SampleCountFlags::TYPE_1);
        made.fill(depths, state);
        made
    }

    /// With several samples, or before it is filled, it holds nothing.
    pub fn of_samples(
        host: &'h Host,
        format: vk::Format,
        extent: [u32; 2],
        samples: vk::SampleCountFlags,
    ) -> Self {
        let [width, height] = extent;
        let usage = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT
            | vk::ImageUsageFlags::SAMPLED
            | vk::ImageUsageFlags::TRANSFER_SRC
            | vk::ImageUsageFlags::TRANSFER_DST;
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(vk::Extent3D {
                width,
                height,
                depth: 1,
            })
            .mip_levels(1)
            .array_layers(1)
            .samples(samples)
            .usage(usage);
        let bytes = 4 * u64::from(width) * u64::from(height);
        let buffer_info = vk::BufferCreateInfo::default()
            .size(bytes)
            .usage(vk::BufferUsageFlags::TRANSFER_DST | vk::BufferUsageFlags::TRANSFER_SRC);
        let reached =
            vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        // SAFETY: plain Vulkan; all of it is destroyed by `drop`, before the device.
        unsafe {
            let device = &host.device;
            let raw = device.create_image(&info, None).unwrap();
            let wanted = device.get_image_memory_requirements(raw);
            let memory = allocate(host, wanted, vk::MemoryPropertyFlags::DEVICE_LOCAL);
            device.bind_image_memory(raw, memory, 0).unwrap();
            let info = vk::ImageViewCreateInfo::default()
                .image(raw)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(format)
                .subresource_range(WHOLE);
            let view = device.create_image_view(&info, None).unwrap();
            let buffer = device.create_buffer(&buffer_info, None).unwrap();
            let wanted = device.get_buffer_memory_requirements(buffer);
            let buffer_memory = allocate(host, wanted, reached);
            device.bind_buffer_memory(buffer, buffer_memory, 0).unwrap();
            Self {
                raw,
                view,
                extent,
                format,
                memory,
                buffer,
                buffer_memory,
                host,
            }
        }
    }

    fn fill(&self, depths: &[f32], state: State) {
        let (made, host, format) = (self, self.host, self.format);
        let texels: Vec<u8> = match format {
            vk::Format::D16_UNORM => depths
                .iter()
                .flat_map(|depth| ((depth * 65535.0).round() as u16).to_ne_bytes())
                .collect(),
            vk::Format::X8_D24_UNORM_PACK32 => depths
                .iter()
                .flat_map(|depth| ((depth * 16_777_215.0).round() as u32).to_ne_bytes())
                .collect(),
            _ => depths
                .iter()
                .flat_map(|depth| depth.to_ne_bytes())
                .collect(),
        };
        let flags = vk::MemoryMapFlags::empty();
        // SAFETY: the memory holds that many bytes, and nothing reads them yet.
        unsafe {
            let device = &host.device;
            let mapped = device.map_memory(self.buffer_memory, 0, vk::WHOLE_SIZE, flags);
            copy_nonoverlapping(texels.as_ptr(), mapped.unwrap().cast::<u8>(), texels.len());
            device.unmap_memory(self.buffer_memory);
        }
        // SAFETY: outside rendering; the image lives until `run` has waited.
        host.run(|cmd| unsafe {
            let nothing = (
                vk::PipelineStageFlags::TOP_OF_PIPE,
                vk::AccessFlags::empty(),
                vk::ImageLayout::UNDEFINED,
            );
            made.barrier(cmd, nothing, COPIED_TO);
            let copy = [made.copied()];
            let device = &host.device;
            device.cmd_copy_buffer_to_image(cmd, made.buffer, made.raw, COPIED_TO.2, &copy);
            made.barrier(cmd, COPIED_TO, state);
        });
    }

    fn copied(&self) -> vk::BufferImageCopy {
        let [width, height] = self.extent;
        vk::BufferImageCopy::default()
            .image_subresource(vk::ImageSubresourceLayers {
                aspect_mask: vk::ImageAspectFlags::DEPTH,
                layer_count: 1,
                ..Default::default()
            })
            .image_extent(vk::Extent3D {
                width,
                height,
                depth: 1,
            })
    }

    /// The host's own barrier.
    ///
    /// # Safety
    /// As `vkCmdPipelineBarrier`.
    pub unsafe fn barrier(&self, cmd: vk::CommandBuffer, before: State, after: State) {
        let barrier = [vk::ImageMemoryBarrier::default()
            .src_access_mask(before.1)
            .dst_access_mask(after.1)
            .old_layout(before.2)
            .new_layout(after.2)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(self.raw)
            .subresource_range(WHOLE)];
        let flags = vk::DependencyFlags::empty();
        let device = &self.host.device;
        // SAFETY: the caller's promise.
        unsafe {
            device.cmd_pipeline_barrier(cmd, before.0, after.0, flags, &[], &[], &barrier);
        }
    }

    /// The numbers that are there after a rendering, the image being [`ATTACHED`], of `D32_SFLOAT`.
    pub fn numbers(&self) -> Vec<f32> {
        assert_eq!(self.format, vk::Format::D32_SFLOAT);
        let count = (self.extent[0] * self.extent[1]) as usize;
        let mut numbers = vec![0f32; count];
        // SAFETY: the image lives until `run` has waited; the memory holds that many bytes.
        unsafe {
            let device = &self.host.device;
            self.host.run(|cmd| {
                self.barrier(cmd, ATTACHED, COPIED_FROM);
                let copy = [self.copied()];
                device.cmd_copy_image_to_buffer(cmd, self.raw, COPIED_FROM.2, self.buffer, &copy);
                let to_host = [vk::MemoryBarrier::default()
                    .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
                    .dst_access_mask(vk::AccessFlags::HOST_READ)];
                device.cmd_pipeline_barrier(
                    cmd,
                    vk::PipelineStageFlags::TRANSFER,
                    vk::PipelineStageFlags::HOST,
                    vk::DependencyFlags::empty(),
                    &to_host,
                    &[],
                    &[],
                );
                self.barrier(cmd, COPIED_FROM, ATTACHED);
            });
            let flags = vk::MemoryMapFlags::empty();
            let memory = self.buffer_memory;
            let mapped = device.map_memory(memory, 0, vk::WHOLE_SIZE, flags).unwrap();
            copy_nonoverlapping(mapped.cast(), numbers.as_mut_ptr(), count);
            device.unmap_memory(memory);
        }
        numbers
    }
}

impl Drop for DepthImage<'_> {
    fn drop(&mut self) {
        let device = &self.host.device;
        // SAFETY: the tests have waited for what used the image, and all of it is the host's own.
        unsafe {
            device.destroy_image_view(self.view, None);
            device.destroy_image(self.raw, None);
            device.free_memory(self.memory, None);
            device.destroy_buffer(self.buffer, None);
            device.free_memory(self.buffer_memory, None);
        }
    }
}
