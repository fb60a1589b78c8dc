//! Plain Vulkan, without stratavox: a device, a picture with a depth buffer, and triangles that are drawn into both.

use ash::vk;
use std::error::Error;

pub const FORMAT: vk::Format = vk::Format::R8G8B8A8_SRGB;
pub const DEPTH_FORMAT: vk::Format = vk::Format::D32_SFLOAT;
/// Of a family with graphics and compute.
pub const QUEUE_FAMILY: u32 = 0;

const SHADERS: &str = "
struct Vertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) color: vec3<f32>,
}

@vertex
fn vertex(@location(0) clip: vec4<f32>, @location(1) color: vec3<f32>) -> Vertex {
    return Vertex(clip, color);
}

@fragment
fn fragment(found: Vertex) -> @location(0) vec4<f32> {
    return vec4(found.color, 1.0);
}
";

/// A corner of a triangle: clip space and linear colour.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Corner {
    pub clip: [f32; 4],
    pub color: [f32; 3],
}

/// What a host has anyway. [`Host::close`] destroys it.
pub struct Host {
    pub entry: ash::Entry,
    pub instance: ash::Instance,
    pub physical_device: vk::PhysicalDevice,
    pub device: ash::Device,
    pub depth_view: vk::ImageView,
    extent: [u32; 2],
    queue: vk::Queue,
    pool: vk::CommandPool,
    cmd: vk::CommandBuffer,
    images: [vk::Image; 2],
    color_view: vk::ImageView,
    /// Corners, and the picture on its way back.
    buffers: [vk::Buffer; 2],
    memory: Vec<vk::DeviceMemory>,
    mapped: [*mut u8; 2],
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
}

/// Corners that there is room for.
const MOST_CORNERS: usize = 1 << 16;

/// What the depth buffer is used for, in turn.
#[derive(Clone, Copy)]
pub enum DepthFor {
    Nothing,
    /// Tested and written.
    Rendering,
    /// Read by compute shaders (rays) and fragment shaders (slices).
    Reading,
}

impl DepthFor {
    pub fn state(self) -> (vk::PipelineStageFlags2, vk::AccessFlags2, vk::ImageLayout) {
        use vk::{AccessFlags2 as Access, ImageLayout as Layout, PipelineStageFlags2 as Stage};
        match self {
            Self::Nothing => (Stage::NONE, Access::NONE, Layout::UNDEFINED),
            Self::Rendering => (
                Stage::EARLY_FRAGMENT_TESTS | Stage::LATE_FRAGMENT_TESTS,
                Access::DEPTH_STENCIL_ATTACHMENT_READ | Access::DEPTH_STENCIL_ATTACHMENT_WRITE,
                Layout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
            ),
            Self::Reading => (
                Stage::COMPUTE_SHADER | Stage::FRAGMENT_SHADER,
                Access::SHADER_SAMPLED_READ,
                Layout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
            ),
        }
    }
}

impl Host {
    /// The first device, with the two features that stratavox requires.
    pub unsafe fn new(extent: [u32; 2]) -> Result<Self, Box<dyn Error>> {
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

            let types = instance.get_physical_device_memory_properties(physical_device);
            let mut memory = Vec::new();
            let mut allocate = |wanted: vk::MemoryRequirements, properties| {
                let index = (0..types.memory_type_count).find(|&k| {
                    let found = types.memory_types[k as usize].property_flags;
                    wanted.memory_type_bits >> k & 1 == 1 && found.contains(properties)
                });
                let info = vk::MemoryAllocateInfo::default()
                    .allocation_size(wanted.size)
                    .memory_type_index(index.unwrap_or_default());
                let made = device.allocate_memory(&info, None);
                memory.extend(made);
                made
            };
            let usages = [
                vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC,
                vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT | vk::ImageUsageFlags::SAMPLED,
            ];
            let aspects = [vk::ImageAspectFlags::COLOR, vk::ImageAspectFlags::DEPTH];
            let formats = [FORMAT, DEPTH_FORMAT];
            let (mut images, mut views) = ([vk::Image::null(); 2], [vk::ImageView::null(); 2]);
            for k in 0..2 {
                let info = vk::ImageCreateInfo::default()
                    .image_type(vk::ImageType::TYPE_2D)
                    .format(formats[k])
                    .extent(whole(extent).extent.into())
                    .mip_levels(1)
                    .array_layers(1)
                    .samples(vk::SampleCountFlags::TYPE_1)
                    .usage(usages[k]);
                images[k] = device.create_image(&info, None)?;
                let wanted = device.get_image_memory_requirements(images[k]);
                let memory = allocate(wanted, vk::MemoryPropertyFlags::DEVICE_LOCAL)?;
                device.bind_image_memory(images[k], memory, 0)?;
                let info = vk::ImageViewCreateInfo::default()
                    .image(images[k])
                    .view_type(vk::ImageViewType::TYPE_2D)
                    .format(formats[k])
                    .subresource_range(all_of(aspects[k]));
                views[k] = device.create_image_view(&info, None)?;
            }
            let sizes = [
                (MOST_CORNERS * size_of::<Corner>()) as u64,
                4 * u64::from(extent[0]) * u64::from(extent[1]),
            ];
            let usages = [
                vk::BufferUsageFlags::VERTEX_BUFFER,
                vk::BufferUsageFlags::TRANSFER_DST,
            ];
            let (mut buffers, mut mapped) = ([vk::Buffer::null(); 2], [std::ptr::null_mut(); 2]);
            for k in 0..2 {
                let info = vk::BufferCreateInfo::default()
                    .size(sizes[k])
                    .usage(usages[k]);
                buffers[k] = device.create_buffer(&info, None)?;
                let wanted = device.get_buffer_memory_requirements(buffers[k]);
                let reached =
                    vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
                let memory = allocate(wanted, reached)?;
                device.bind_buffer_memory(buffers[k], memory, 0)?;
                let flags = vk::MemoryMapFlags::empty();
                mapped[k] = device.map_memory(memory, 0, sizes[k], flags)?.cast();
            }
            let info = vk::PipelineLayoutCreateInfo::default();
            let layout = device.create_pipeline_layout(&info, None)?;
            let pipeline = pipeline(&device, layout)?;
            let info = vk::CommandPoolCreateInfo::default()
                .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
            let pool = device.create_command_pool(&info, None)?;
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(pool)
                .command_buffer_count(1);
            Ok(Self {
                queue: device.get_device_queue(QUEUE_FAMILY, 0),
                cmd: device.allocate_command_buffers(&info)?[0],
                pool,
                images,
                color_view: views[0],
                depth_view: views[1],
                buffers,
                mapped,
                memory,
                layout,
                pipeline,
                extent,
                entry,
                instance,
                physical_device,
                device,
            })
        }
    }

    /// Records a frame, submits it, and waits: hosts with frames in flight do not.
    pub unsafe fn frame(
        &self,
        record: impl FnOnce(vk::CommandBuffer) -> Result<(), Box<dyn Error>>,
    ) -> Result<(), Box<dyn Error>> {
        let cmds = [self.cmd];
        let submit = [vk::SubmitInfo::default().command_buffers(&cmds)];
        // SAFETY: the frame before is done; the queue is ours alone.
        unsafe {
            let info = vk::CommandBufferBeginInfo::default();
            self.device.begin_command_buffer(self.cmd, &info)?;
            record(self.cmd)?;
            self.device.end_command_buffer(self.cmd)?;
            self.device
                .queue_submit(self.queue, &submit, vk::Fence::null())?;
            Ok(self.device.queue_wait_idle(self.queue)?)
        }
    }

    /// Begins rendering with what was there kept, or with a background and the farthest depth.
    pub unsafe fn begin_rendering(&self, cmd: vk::CommandBuffer, background: Option<[f32; 4]>) {
        let layout = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
        let (stage, access) = (
            vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT,
            vk::AccessFlags2::COLOR_ATTACHMENT_READ | vk::AccessFlags2::COLOR_ATTACHMENT_WRITE,
        );
        let load = match background {
            Some(_) => vk::AttachmentLoadOp::CLEAR,
            None => vk::AttachmentLoadOp::LOAD,
        };
        let before = match background {
            Some(_) => DepthFor::Nothing.state(),
            None => (stage, access, layout),
        };
        let attachment = |view, layout, clear_value| {
            vk::RenderingAttachmentInfo::default()
                .image_view(view)
                .image_layout(layout)
                .load_op(load)
                .store_op(vk::AttachmentStoreOp::STORE)
                .clear_value(clear_value)
        };
        let float32 = background.unwrap_or_default();
        let color = vk::ClearColorValue { float32 };
        let colors = [attachment(
            self.color_view,
            layout,
            vk::ClearValue { color },
        )];
        // Reverse Z: far is 0.
        let depth_stencil = vk::ClearDepthStencilValue::default();
        let clear = vk::ClearValue { depth_stencil };
        let depth = attachment(self.depth_view, DepthFor::Rendering.state().2, clear);
        let info = vk::RenderingInfo::default()
            .render_area(whole(self.extent))
            .layer_count(1)
            .color_attachments(&colors)
            .depth_attachment(&depth);
        // SAFETY: the caller's command buffer is recording outside rendering.
        unsafe {
            self.barrier(cmd, 0, before, (stage, access, layout));
            self.device.cmd_begin_rendering(cmd, &info);
        }
    }

    /// Brings the depth buffer from one use to the next.
    pub unsafe fn depth_barrier(&self, cmd: vk::CommandBuffer, before: DepthFor, after: DepthFor) {
        // SAFETY: the caller's command buffer is recording outside rendering.
        unsafe { self.barrier(cmd, 1, before.state(), after.state()) };
    }

    unsafe fn barrier(
        &self,
        cmd: vk::CommandBuffer,
        image: usize,
        before: (vk::PipelineStageFlags2, vk::AccessFlags2, vk::ImageLayout),
        after: (vk::PipelineStageFlags2, vk::AccessFlags2, vk::ImageLayout),
    ) {
        let aspect = [vk::ImageAspectFlags::COLOR, vk::ImageAspectFlags::DEPTH][image];
        let barrier = [vk::ImageMemoryBarrier2::default()
            .src_stage_mask(before.0)
            .src_access_mask(before.1)
            .old_layout(before.2)
            .dst_stage_mask(after.0)
            .dst_access_mask(after.1)
            .new_layout(after.2)
            .image(self.images[image])
            .subresource_range(all_of(aspect))];
        let info = vk::DependencyInfo::default().image_memory_barriers(&barrier);
        // SAFETY: the caller's promise.
        unsafe { self.device.cmd_pipeline_barrier2(cmd, &info) };
    }

    /// Draws triangles, inside rendering.
    pub unsafe fn draw(&self, cmd: vk::CommandBuffer, corners: &[Corner]) {
        let corners = &corners[..corners.len().min(MOST_CORNERS)];
        let bytes: &[u8] = bytemuck::cast_slice(corners);
        let [width, height] = self.extent.map(|n| n as f32);
        let viewport = vk::Viewport {
            width,
            height,
            max_depth: 1.0,
            ..Default::default()
        };
        // SAFETY: the frame before is done with the buffer, which has room; the caller's command buffer is recording.
        unsafe {
            std::ptr::copy_nonoverlapping(bytes.as_ptr(), self.mapped[0], bytes.len());
            let (device, point) = (&self.device, vk::PipelineBindPoint::GRAPHICS);
            device.cmd_bind_pipeline(cmd, point, self.pipeline);
            device.cmd_set_viewport(cmd, 0, &[viewport]);
            device.cmd_set_scissor(cmd, 0, &[whole(self.extent)]);
            device.cmd_bind_vertex_buffers(cmd, 0, &[self.buffers[0]], &[0]);
            device.cmd_draw(cmd, corners.len() as u32, 1, 0, 0);
        }
    }

    /// Ends rendering and copies the picture to where the CPU reads it.
    pub unsafe fn finish(&self, cmd: vk::CommandBuffer) {
        use vk::{AccessFlags2 as Access, ImageLayout as Layout, PipelineStageFlags2 as Stage};
        let drawn = (
            Stage::COLOR_ATTACHMENT_OUTPUT,
            Access::COLOR_ATTACHMENT_WRITE,
            Layout::COLOR_ATTACHMENT_OPTIMAL,
        );
        let copied = (
            Stage::COPY,
            Access::TRANSFER_READ,
            Layout::TRANSFER_SRC_OPTIMAL,
        );
        let copy = [vk::BufferImageCopy::default()
            .image_subresource(vk::ImageSubresourceLayers {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                layer_count: 1,
                ..Default::default()
            })
            .image_extent(whole(self.extent).extent.into())];
        let to_host = [vk::MemoryBarrier2::default()
            .src_stage_mask(Stage::COPY)
            .src_access_mask(Access::TRANSFER_WRITE)
            .dst_stage_mask(Stage::HOST)
            .dst_access_mask(Access::HOST_READ)];
        let info = vk::DependencyInfo::default().memory_barriers(&to_host);
        // SAFETY: the caller's command buffer is recording inside rendering.
        unsafe {
            let (device, image) = (&self.device, self.images[0]);
            device.cmd_end_rendering(cmd);
            self.barrier(cmd, 0, drawn, copied);
            device.cmd_copy_image_to_buffer(cmd, image, copied.2, self.buffers[1], &copy);
            device.cmd_pipeline_barrier2(cmd, &info);
        }
    }

    /// What was drawn, sRGB red, green, blue and alpha.
    pub fn texels(&self) -> &[u8] {
        let bytes = 4 * self.extent[0] as usize * self.extent[1] as usize;
        // SAFETY: the buffer holds that many bytes, and the device has finished.
        unsafe { std::slice::from_raw_parts(self.mapped[1], bytes) }
    }

    /// Destroys what [`Host::new`] made.
    pub unsafe fn close(self) {
        let device = &self.device;
        // SAFETY: the device has finished, and nothing else is left on it.
        unsafe {
            device.destroy_command_pool(self.pool, None);
            device.destroy_pipeline(self.pipeline, None);
            device.destroy_pipeline_layout(self.layout, None);
            device.destroy_image_view(self.color_view, None);
            device.destroy_image_view(self.depth_view, None);
            for image in self.images {
                device.destroy_image(image, None);
            }
            for buffer in self.buffers {
                device.destroy_buffer(buffer, None);
            }
            for memory in self.memory {
                device.free_memory(memory, None);
            }
            device.destroy_device(None);
            self.instance.destroy_instance(None);
        }
    }
}

fn whole([width, height]: [u32; 2]) -> vk::Rect2D {
    vk::Extent2D { width, height }.into()
}

fn all_of(aspect_mask: vk::ImageAspectFlags) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange {
        aspect_mask,
        level_count: 1,
        layer_count: 1,
        ..Default::default()
    }
}

/// Opaque triangles with reverse Z.
unsafe fn pipeline(
    device: &ash::Device,
    layout: vk::PipelineLayout,
) -> Result<vk::Pipeline, Box<dyn Error>> {
    use naga::valid::{Capabilities, ValidationFlags, Validator};
    let module = naga::front::wgsl::parse_str(SHADERS)?;
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let info = validator.validate(&module)?;
    let options = naga::back::spv::Options {
        // y points down in clip space, as Vulkan has it.
        flags: naga::back::spv::WriterFlags::empty(),
        ..Default::default()
    };
    let words = naga::back::spv::write_vec(&module, &info, &options, None)?;
    let info = vk::ShaderModuleCreateInfo::default().code(&words);
    // SAFETY: the words are naga's; every structure lives until its call returns.
    unsafe {
        let shaders = device.create_shader_module(&info, None)?;
        let stage = |stage, name| {
            vk::PipelineShaderStageCreateInfo::default()
                .stage(stage)
                .module(shaders)
                .name(name)
        };
        let stages = [
            stage(vk::ShaderStageFlags::VERTEX, c"vertex"),
            stage(vk::ShaderStageFlags::FRAGMENT, c"fragment"),
        ];
        let bindings =
            [vk::VertexInputBindingDescription::default().stride(size_of::<Corner>() as u32)];
        let attribute = |location, format, offset| {
            vk::VertexInputAttributeDescription::default()
                .location(location)
                .format(format)
                .offset(offset)
        };
        let attributes = [
            attribute(0, vk::Format::R32G32B32A32_SFLOAT, 0),
            attribute(1, vk::Format::R32G32B32_SFLOAT, 16),
        ];
        let input = vk::PipelineVertexInputStateCreateInfo::default()
            .vertex_binding_descriptions(&bindings)
            .vertex_attribute_descriptions(&attributes);
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport = vk::PipelineViewportStateCreateInfo::default()
            .viewport_count(1)
            .scissor_count(1);
        let rasterization = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
        let samples = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(true)
            .depth_write_enable(true)
            .depth_compare_op(vk::CompareOp::GREATER);
        let attachments = [vk::PipelineColorBlendAttachmentState::default()
            .color_write_mask(vk::ColorComponentFlags::RGBA)];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&attachments);
        let dynamic = vk::PipelineDynamicStateCreateInfo::default()
            .dynamic_states(&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR]);
        let formats = [FORMAT];
        let mut rendering = vk::PipelineRenderingCreateInfo::default()
            .color_attachment_formats(&formats)
            .depth_attachment_format(DEPTH_FORMAT);
        let info = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stages)
            .vertex_input_state(&input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&rasterization)
            .multisample_state(&samples)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(layout)
            .push_next(&mut rendering);
        let made = device
            .create_graphics_pipelines(vk::PipelineCache::null(), &[info], None)
            .map_err(|(_, error)| error);
        device.destroy_shader_module(shaders, None);
        Ok(made?[0])
    }
}
