//! An image of the host's, made without stratavox, and the way back to the CPU.

use super::Host;
use ash::vk;
use stratavox::gpu::{Target, Use};

pub struct HostImage<'h> {
    pub raw: vk::Image,
    pub view: vk::ImageView,
    pub format: vk::Format,
    pub extent: [u32; 2],
    memory: vk::DeviceMemory,
    readback: vk::Buffer,
    readback_memory: vk::DeviceMemory,
    host: &'h Host,
}

impl<'h> HostImage<'h> {
    pub fn new(host: &'h Host, format: vk::Format, extent: [u32; 2]) -> Self {
        Self::of_samples(host, format, extent, vk::SampleCountFlags::TYPE_1)
    }

    /// What a renderer draws into: nothing is kept of it, and what is drawn can be fetched.
    pub fn target(&self) -> Target {
        Target {
            image: self.raw,
            view: self.view,
            format: self.format,
            extent: self.extent,
            before: Use::Nothing.into(),
            after: Use::TransferRead.into(),
        }
    }

    /// With several samples it cannot be fetched.
    pub fn of_samples(
        host: &'h Host,
        format: vk::Format,
        [width, height]: [u32; 2],
        samples: vk::SampleCountFlags,
    ) -> Self {
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT
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
        let bytes = u64::from(width) * u64::from(height) * texel_bytes(format) as u64;
        let buffer_info = vk::BufferCreateInfo::default()
            .size(bytes)
            .usage(vk::BufferUsageFlags::TRANSFER_DST);
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
            let readback = device.create_buffer(&buffer_info, None).unwrap();
            let wanted = device.get_buffer_memory_requirements(readback);
            let reached =
                vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
            let readback_memory = allocate(host, wanted, reached);
            device
                .bind_buffer_memory(readback, readback_memory, 0)
                .unwrap();
            Self {
                raw,
                view,
                format,
                extent: [width, height],
                memory,
                readback,
                readback_memory,
                host,
            }
        }
    }

    /// The host's own barrier.
    ///
    /// # Safety
    /// As `vkCmdPipelineBarrier`.
    pub unsafe fn barrier(
        &self,
        cmd: vk::CommandBuffer,
        before: (vk::PipelineStageFlags, vk::AccessFlags, vk::ImageLayout),
        after: (vk::PipelineStageFlags, vk::AccessFlags, vk::ImageLayout),
    ) {
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
        // SAFETY: the caller's promise.
        unsafe {
            self.host.device.cmd_pipeline_barrier(
                cmd,
                before.0,
                after.0,
                flags,
                &[],
                &[],
                &barrier,
            );
        }
    }

    /// Brings a new image to where it can be drawn into.
    ///
    /// # Safety
    /// `cmd` is recording outside rendering.
    pub unsafe fn make_target(&self, cmd: vk::CommandBuffer) {
        let stage = vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT;
        // The reads of an earlier copy, if any, are over: `stage` waits for them.
        let before = vk::PipelineStageFlags::TRANSFER;
        let access =
            vk::AccessFlags::COLOR_ATTACHMENT_WRITE | vk::AccessFlags::COLOR_ATTACHMENT_READ;
        let layout = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
        let nothing = (before, vk::AccessFlags::empty(), vk::ImageLayout::UNDEFINED);
        // SAFETY: the caller's promise.
        unsafe { self.barrier(cmd, nothing, (stage, access, layout)) };
    }

    /// Brings the image to where a copy reads it, and copies it to where the CPU does.
    ///
    /// # Safety
    /// `cmd` is recording outside rendering; the image is as `before` says.
    pub unsafe fn fetch(
        &self,
        cmd: vk::CommandBuffer,
        before: (vk::PipelineStageFlags, vk::AccessFlags, vk::ImageLayout),
    ) {
        let after = (
            vk::PipelineStageFlags::TRANSFER,
            vk::AccessFlags::TRANSFER_READ,
            vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
        );
        // SAFETY: the caller's promise.
        unsafe {
            self.barrier(cmd, before, after);
            self.copy_from(cmd, after.2);
        }
    }

    /// Clears a new image to what the host draws, by a transfer, and leaves it in `TRANSFER_DST_OPTIMAL`.
    ///
    /// # Safety
    /// `cmd` is recording outside rendering.
    pub unsafe fn clear(&self, cmd: vk::CommandBuffer, drawn: [f32; 4]) {
        let stage = vk::PipelineStageFlags::TRANSFER;
        let layout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        let nothing = (stage, vk::AccessFlags::empty(), vk::ImageLayout::UNDEFINED);
        let color = vk::ClearColorValue { float32: drawn };
        // SAFETY: the caller's promise.
        unsafe {
            self.barrier(
                cmd,
                nothing,
                (stage, vk::AccessFlags::TRANSFER_WRITE, layout),
            );
            let device = &self.host.device;
            device.cmd_clear_color_image(cmd, self.raw, layout, &color, &[WHOLE]);
        }
    }

    /// Copies the image, which is in `layout`, to where the CPU reads it.
    ///
    /// # Safety
    /// `cmd` is recording outside rendering; copies may read the image now.
    pub unsafe fn copy_from(&self, cmd: vk::CommandBuffer, layout: vk::ImageLayout) {
        let [width, height] = self.extent;
        let copy = [vk::BufferImageCopy::default()
            .image_subresource(vk::ImageSubresourceLayers {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                layer_count: 1,
                ..Default::default()
            })
            .image_extent(vk::Extent3D {
                width,
                height,
                depth: 1,
            })];
        let to_host = [vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
            .dst_access_mask(vk::AccessFlags::HOST_READ)];
        let device = &self.host.device;
        // SAFETY: the caller's promise.
        unsafe {
            device.cmd_copy_image_to_buffer(cmd, self.raw, layout, self.readback, &copy);
            device.cmd_pipeline_barrier(
                cmd,
                vk::PipelineStageFlags::TRANSFER,
                vk::PipelineStageFlags::HOST,
                vk::DependencyFlags::empty(),
                &to_host,
                &[],
                &[],
            );
        }
    }

    /// [`HostImage::fetch`] of what was just drawn.
    ///
    /// # Safety
    /// As [`HostImage::fetch`], where the image is a color attachment.
    pub unsafe fn fetch_drawn(&self, cmd: vk::CommandBuffer) {
        let stage = vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT;
        let layout = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
        let drawn = (stage, vk::AccessFlags::COLOR_ATTACHMENT_WRITE, layout);
        // SAFETY: the caller's promise.
        unsafe { self.fetch(cmd, drawn) };
    }

    /// The numbers that a finished submission has fetched, (red, green, blue, alpha) as they are stored: 0 to
    /// 255 for formats of 8 bits, 0 to 1023 (and an alpha of 0 to 3) for those of 10.
    pub fn numbers(&self) -> Vec<[f64; 4]> {
        let size = texel_bytes(self.format);
        let count = self.extent.iter().product::<u32>() as usize;
        let mut bytes = vec![0; count * size];
        // SAFETY: the memory is mapped once at a time and holds that many bytes; the submission is finished.
        unsafe {
            let (device, flags) = (&self.host.device, vk::MemoryMapFlags::empty());
            let mapped = device
                .map_memory(self.readback_memory, 0, vk::WHOLE_SIZE, flags)
                .unwrap();
            std::ptr::copy_nonoverlapping(mapped.cast(), bytes.as_mut_ptr(), bytes.len());
            device.unmap_memory(self.readback_memory);
        }
        let texel = |texel: &[u8]| match self.format {
            vk::Format::R8G8B8A8_SRGB | vk::Format::R8G8B8A8_UNORM => {
                [0, 1, 2, 3].map(|c| f64::from(texel[c]))
            }
            vk::Format::B8G8R8A8_UNORM => [2, 1, 0, 3].map(|c| f64::from(texel[c])),
            vk::Format::A2B10G10R10_UNORM_PACK32 => {
                let word = u32::from_le_bytes(texel.try_into().unwrap());
                [0, 10, 20, 30].map(|bit| f64::from(word >> bit & 0x3ff))
            }
            // Without a sign: five bits of exponent with a bias of 15, and six or five of mantissa. No alpha: 1.
            vk::Format::B10G11R11_UFLOAT_PACK32 => {
                let word = u32::from_le_bytes(texel.try_into().unwrap());
                let half = |bits: u32, to: u32| half::f16::from_bits((bits << to) as u16).to_f64();
                let red = half(word & 0x7ff, 4);
                let green = half(word >> 11 & 0x7ff, 4);
                [red, green, half(word >> 22, 5), 1.0]
            }
            vk::Format::R16G16B16A16_SFLOAT => [0, 1, 2, 3]
                .map(|c| half::f16::from_le_bytes([texel[2 * c], texel[2 * c + 1]]).to_f64()),
            vk::Format::R32G32B32A32_SFLOAT => [0, 1, 2, 3]
                .map(|c| f32::from_le_bytes(texel[4 * c..4 * c + 4].try_into().unwrap()).into()),
            other => panic!("{other:?} is not one of the host's formats"),
        };
        bytes.chunks(size).map(texel).collect()
    }
}

impl Drop for HostImage<'_> {
    fn drop(&mut self) {
        let device = &self.host.device;
        // SAFETY: the tests have waited for what used the image, and all of it is the host's own.
        unsafe {
            device.destroy_image_view(self.view, None);
            device.destroy_image(self.raw, None);
            device.free_memory(self.memory, None);
            device.destroy_buffer(self.readback, None);
            device.free_memory(self.readback_memory, None);
        }
    }
}

const WHOLE: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: 1,
};

fn texel_bytes(format: vk::Format) -> usize {
    match format {
        vk::Format::R16G16B16A16_SFLOAT => 8,
        vk::Format::R32G32B32A32_SFLOAT => 16,
        _ => 4,
    }
}

pub(super) unsafe fn allocate(
    host: &Host,
    wanted: vk::MemoryRequirements,
    properties: vk::MemoryPropertyFlags,
) -> vk::DeviceMemory {
    let types = host.memory.memory_types_as_slice();
    let is_right = |&k: &usize| {
        wanted.memory_type_bits >> k & 1 == 1 && types[k].property_flags.contains(properties)
    };
    let index = (0..types.len())
        .find(is_right)
        .expect("memory of that kind");
    let info = vk::MemoryAllocateInfo::default()
        .allocation_size(wanted.size)
        .memory_type_index(index as u32);
    // SAFETY: the type is one of the device's.
    unsafe { host.device.allocate_memory(&info, None).unwrap() }
}
