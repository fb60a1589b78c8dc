//! Plain Vulkan, without stratavox: a device, an image to draw into and a buffer to read it from.

use super::{BACKGROUND, EXTENT, FORMAT};
use ash::vk;

/// What a host has anyway. [`Host::close`] destroys it.
pub struct Host {
    pub entry: ash::Entry,
    pub instance: ash::Instance,
    pub physical_device: vk::PhysicalDevice,
    pub device: ash::Device,
    queue: vk::Queue,
    pool: vk::CommandPool,
    image: vk::Image,
    view: vk::ImageView,
    readback: vk::Buffer,
    memory: [vk::DeviceMemory; 2],
}

/// Of a family with graphics and compute: the first one of every device that draws.
pub const QUEUE_FAMILY: u32 = 0;

const BYTES: u64 = EXTENT[0] as u64 * EXTENT[1] as u64 * 4;

const WHOLE: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: 1,
};

impl Host {
    /// The first device, with the two features that stratavox requires.
    pub unsafe fn new() -> Result<Self, Box<dyn std::error::Error>> {
        // SAFETY: plain set-up; every structure lives until its call returns.
        unsafe {
            let entry = ash::Entry::load()?;
            let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_3);
            let info = vk::InstanceCreateInfo::default().application_info(&application);
            let instance = entry.create_instance(&info, None)?;
            let physical_devices = instance.enumerate_physical_devices()?;
            let physical_device = *physical_devices.first().ok_or("no Vulkan device")?;
            let mut features = vk::PhysicalDeviceVulkan13Features::default()
                .dynamic_rendering(true)
                .synchronization2(true);
            let queues = [vk::DeviceQueueCreateInfo::default()
                .queue_family_index(QUEUE_FAMILY)
                .queue_priorities(&[1.0])];
            let info = vk::DeviceCreateInfo::default()
                .queue_create_infos(&queues)
                .push_next(&mut features);
            let device = instance.create_device(physical_device, &info, None)?;

            let info = vk::ImageCreateInfo::default()
                .image_type(vk::ImageType::TYPE_2D)
                .format(FORMAT)
                .extent(vk::Extent3D::from(extent()))
                .mip_levels(1)
                .array_layers(1)
                .samples(vk::SampleCountFlags::TYPE_1)
                .usage(vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC);
            let image = device.create_image(&info, None)?;
            let usage = vk::BufferUsageFlags::TRANSFER_DST;
            let info = vk::BufferCreateInfo::default().size(BYTES).usage(usage);
            let readback = device.create_buffer(&info, None)?;
            let types = instance.get_physical_device_memory_properties(physical_device);
            let allocate = |wanted: vk::MemoryRequirements, properties| {
                let index = (0..types.memory_type_count).find(|&k| {
                    let found = types.memory_types[k as usize].property_flags;
                    wanted.memory_type_bits >> k & 1 == 1 && found.contains(properties)
                });
                let info = vk::MemoryAllocateInfo::default()
                    .allocation_size(wanted.size)
                    .memory_type_index(index.unwrap_or_default());
                device.allocate_memory(&info, None)
            };
            let memory = [
                allocate(
                    device.get_image_memory_requirements(image),
                    vk::MemoryPropertyFlags::DEVICE_LOCAL,
                )?,
                allocate(
                    device.get_buffer_memory_requirements(readback),
                    vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT,
                )?,
            ];
            device.bind_image_memory(image, memory[0], 0)?;
            device.bind_buffer_memory(readback, memory[1], 0)?;
            let info = vk::ImageViewCreateInfo::default()
                .image(image)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(FORMAT)
                .subresource_range(WHOLE);
            Ok(Self {
                queue: device.get_device_queue(QUEUE_FAMILY, 0),
                pool: device.create_command_pool(&vk::CommandPoolCreateInfo::default(), None)?,
                image,
                view: device.create_image_view(&info, None)?,
                readback,
                memory,
                entry,
                instance,
                physical_device,
                device,
            })
        }
    }

    /// A command buffer that is being recorded.
    pub unsafe fn begin(&self) -> Result<vk::CommandBuffer, vk::Result> {
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(self.pool)
            .command_buffer_count(1);
        // SAFETY: the pool is ours, and the buffer is new.
        unsafe {
            let cmd = self.device.allocate_command_buffers(&info)?[0];
            let info = vk::CommandBufferBeginInfo::default();
            self.device.begin_command_buffer(cmd, &info)?;
            Ok(cmd)
        }
    }

    /// The host's own rendering to its own image. What it draws here is a background.
    pub unsafe fn begin_rendering(&self, cmd: vk::CommandBuffer) {
        let barrier = [vk::ImageMemoryBarrier2::default()
            .dst_stage_mask(vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT)
            .dst_access_mask(vk::AccessFlags2::COLOR_ATTACHMENT_WRITE)
            .new_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
            .image(self.image)
            .subresource_range(WHOLE)];
        let dependency = vk::DependencyInfo::default().image_memory_barriers(&barrier);
        let background = vk::ClearValue {
            color: vk::ClearColorValue {
                float32: BACKGROUND,
            },
        };
        let attachments = [vk::RenderingAttachmentInfo::default()
            .image_view(self.view)
            .image_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::STORE)
            .clear_value(background)];
        let info = vk::RenderingInfo::default()
            .render_area(extent().into())
            .layer_count(1)
            .color_attachments(&attachments);
        // SAFETY: the caller's command buffer is recording outside rendering; the image is new.
        unsafe {
            self.device.cmd_pipeline_barrier2(cmd, &dependency);
            self.device.cmd_begin_rendering(cmd, &info);
        }
    }

    /// Ends the rendering and copies the image to where the CPU reads it.
    pub unsafe fn end_rendering(&self, cmd: vk::CommandBuffer) {
        let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        let barrier = [vk::ImageMemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT)
            .src_access_mask(vk::AccessFlags2::COLOR_ATTACHMENT_WRITE)
            .dst_stage_mask(vk::PipelineStageFlags2::COPY)
            .dst_access_mask(vk::AccessFlags2::TRANSFER_READ)
            .old_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
            .new_layout(layout)
            .image(self.image)
            .subresource_range(WHOLE)];
        let drawn = vk::DependencyInfo::default().image_memory_barriers(&barrier);
        let copy = [vk::BufferImageCopy::default()
            .image_subresource(vk::ImageSubresourceLayers {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                layer_count: 1,
                ..Default::default()
            })
            .image_extent(extent().into())];
        let to_host = [vk::MemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::COPY)
            .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
            .dst_stage_mask(vk::PipelineStageFlags2::HOST)
            .dst_access_mask(vk::AccessFlags2::HOST_READ)];
        let copied = vk::DependencyInfo::default().memory_barriers(&to_host);
        let device = &self.device;
        // SAFETY: the caller's command buffer is recording inside `begin_rendering`.
        unsafe {
            device.cmd_end_rendering(cmd);
            device.cmd_pipeline_barrier2(cmd, &drawn);
            device.cmd_copy_image_to_buffer(cmd, self.image, layout, self.readback, &copy);
            device.cmd_pipeline_barrier2(cmd, &copied);
        }
    }

    /// Hosts with frames in flight do not wait here.
    pub unsafe fn submit_and_wait(&self, cmd: vk::CommandBuffer) -> Result<(), vk::Result> {
        let cmds = [cmd];
        let submit = [vk::SubmitInfo::default().command_buffers(&cmds)];
        // SAFETY: the caller's command buffer is recording; the queue is ours alone.
        unsafe {
            self.device.end_command_buffer(cmd)?;
            self.device
                .queue_submit(self.queue, &submit, vk::Fence::null())?;
            self.device.queue_wait_idle(self.queue)
        }
    }

    /// What was drawn, sRGB red, green, blue and alpha.
    pub unsafe fn texels(&self) -> Result<Vec<u8>, vk::Result> {
        let flags = vk::MemoryMapFlags::empty();
        let mut texels = vec![0; BYTES as usize];
        // SAFETY: the memory holds that many bytes, and the device has finished.
        unsafe {
            let mapped = self.device.map_memory(self.memory[1], 0, BYTES, flags)?;
            std::ptr::copy_nonoverlapping(mapped.cast(), texels.as_mut_ptr(), texels.len());
            self.device.unmap_memory(self.memory[1]);
        }
        Ok(texels)
    }

    /// Destroys what [`Host::new`] made.
    pub unsafe fn close(self) {
        let device = &self.device;
        // SAFETY: the device has finished, and nothing else is left on it.
        unsafe {
            device.destroy_command_pool(self.pool, None);
            device.destroy_image_view(self.view, None);
            device.destroy_image(self.image, None);
            device.destroy_buffer(self.readback, None);
            for memory in self.memory {
                device.free_memory(memory, None);
            }
            device.destroy_device(None);
            self.instance.destroy_instance(None);
        }
    }
}

fn extent() -> vk::Extent2D {
    vk::Extent2D {
        width: EXTENT[0],
        height: EXTENT[1],
    }
}
