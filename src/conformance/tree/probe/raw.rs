//! Objects of Vulkan that the library has no need of and probes have: images of depth, memory that several share, states
//! of pipelines.

use crate::conformance::case::Stop;
use crate::gpu::owned::{Own, OwnMemory};
use crate::gpu::pipeline::{first, module, stage};
use crate::gpu::{self, Bindings, Buffer, Gpu, Layout};
use crate::shaders::shader;
use ash::vk::{self, AccessFlags2 as Access, ImageLayout, PipelineStageFlags2 as Stage};
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{AllocationCreateDesc, AllocationScheme};
use std::sync::Arc;

/// What Vulkan has said, as an error of ours.
pub fn refused(doing: &str) -> impl Fn(vk::Result) -> Stop {
    move |result| {
        let doing = doing.to_owned();
        match result {
            vk::Result::ERROR_DEVICE_LOST => gpu::Error::DeviceLost { doing }.into(),
            vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => gpu::Error::OutOfMemory {
                doing,
                memory: "device",
            }
            .into(),
            result => gpu::Error::Vulkan { doing, result }.into(),
        }
    }
}

/// Stage, access and layout of an image.
pub type State = (Stage, Access, ImageLayout);

/// Depth that is tested and written.
pub const DEPTH_TARGET: State = (
    Stage::from_raw(Stage::EARLY_FRAGMENT_TESTS.as_raw() | Stage::LATE_FRAGMENT_TESTS.as_raw()),
    Access::from_raw(
        Access::DEPTH_STENCIL_ATTACHMENT_READ.as_raw()
            | Access::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
    ),
    ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
);

/// An image of any aspect.
#[derive(Debug)]
pub struct RawImage {
    view: Own<vk::ImageView>,
    raw: Own<vk::Image>,
    /// `None`: it shares what another owner has.
    _memory: Option<OwnMemory>,
    range: vk::ImageSubresourceRange,
}

impl RawImage {
    /// With memory of its own.
    pub fn new(
        gpu: &Arc<Gpu>,
        info: &vk::ImageCreateInfo<'_>,
        aspect: vk::ImageAspectFlags,
    ) -> Result<Self, Stop> {
        let (raw, wants) = unbound(gpu, info)?;
        let owned = memory(gpu, wants, MemoryLocation::GpuOnly, false)?;
        let (handle, offset) = place(&owned);
        Self::bound(gpu, raw, info, aspect, handle, offset, Some(owned))
    }

    /// All in the same place of one memory, which has to outlive them.
    pub fn sharing<const N: usize>(
        gpu: &Arc<Gpu>,
        infos: [&vk::ImageCreateInfo<'_>; N],
    ) -> Result<([Self; N], OwnMemory), Stop> {
        Self::sharing_with(gpu, infos, together([]))
    }

    /// The same with what another thing wants of that memory.
    pub fn sharing_with<const N: usize>(
        gpu: &Arc<Gpu>,
        infos: [&vk::ImageCreateInfo<'_>; N],
        other: vk::MemoryRequirements,
    ) -> Result<([Self; N], OwnMemory), Stop> {
        let mut made = Vec::new();
        for info in infos {
            made.push(unbound(gpu, info)?);
        }
        let wants = together(made.iter().map(|(_, wants)| *wants).chain([other]));
        let owned = memory(gpu, wants, MemoryLocation::GpuOnly, false)?;
        let (handle, offset) = place(&owned);
        let color = vk::ImageAspectFlags::COLOR;
        let mut images = Vec::new();
        for ((raw, _), info) in made.into_iter().zip(infos) {
            images.push(Self::bound(gpu, raw, info, color, handle, offset, None)?);
        }
        let images = images.try_into().expect("as many as infos");
        Ok((images, owned))
    }

    fn bound(
        gpu: &Arc<Gpu>,
        raw: Own<vk::Image>,
        info: &vk::ImageCreateInfo<'_>,
        aspect: vk::ImageAspectFlags,
        memory: vk::DeviceMemory,
        offset: u64,
        owned: Option<OwnMemory>,
    ) -> Result<Self, Stop> {
        // SAFETY: the memory was allocated for what this image wants, and lives as long as its owner says.
        unsafe { gpu.device().bind_image_memory(raw.get(), memory, offset) }
            .map_err(refused("bind memory"))?;
        let range = vk::ImageSubresourceRange::default()
            .aspect_mask(aspect)
            .level_count(info.mip_levels)
            .layer_count(info.array_layers);
        let kind = match (info.image_type, info.array_layers) {
            (vk::ImageType::TYPE_3D, _) => vk::ImageViewType::TYPE_3D,
            (_, 1) => vk::ImageViewType::TYPE_2D,
            _ => vk::ImageViewType::TYPE_2D_ARRAY,
        };
        let info = vk::ImageViewCreateInfo::default()
            .image(raw.get())
            .view_type(kind)
            .format(info.format)
            .subresource_range(range);
        // SAFETY: the image has memory, and the view is of its kind and format.
        let view = unsafe { gpu.device().create_image_view(&info, None) };
        let view = Own::new(gpu, view.map_err(refused("make a view"))?);
        Ok(Self {
            view,
            raw,
            _memory: owned,
            range,
        })
    }

    pub fn raw(&self) -> vk::Image {
        self.raw.get()
    }

    pub fn view(&self) -> vk::ImageView {
        self.view.get()
    }

    /// Orders two uses of all of it.
    ///
    /// # Safety
    /// `cmd` is recording on the device, outside rendering, and the image lives until it has run.
    pub unsafe fn barrier(&self, cmd: vk::CommandBuffer, before: State, after: State) {
        let barriers = [vk::ImageMemoryBarrier2::default()
            .src_stage_mask(before.0)
            .src_access_mask(before.1)
            .old_layout(before.2)
            .dst_stage_mask(after.0)
            .dst_access_mask(after.1)
            .new_layout(after.2)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(self.raw())
            .subresource_range(self.range)];
        let info = vk::DependencyInfo::default().image_memory_barriers(&barriers);
        // SAFETY: the caller's promise.
        unsafe { self.raw.gpu().device().cmd_pipeline_barrier2(cmd, &info) };
    }

    /// All of it, for a copy from or to tightly packed texels at the start of a buffer.
    pub fn whole(&self, extent: [u32; 3]) -> vk::BufferImageCopy {
        let [width, height, depth] = extent;
        let is_array = self.range.layer_count > 1;
        vk::BufferImageCopy::default()
            .image_subresource(vk::ImageSubresourceLayers {
                aspect_mask: self.range.aspect_mask,
                mip_level: 0,
                base_array_layer: 0,
                layer_count: self.range.layer_count,
            })
            .image_extent(vk::Extent3D {
                width,
                height,
                depth: if is_array { 1 } else { depth },
            })
    }
}

fn unbound(
    gpu: &Arc<Gpu>,
    info: &vk::ImageCreateInfo<'_>,
) -> Result<(Own<vk::Image>, vk::MemoryRequirements), Stop> {
    // SAFETY: the device is valid; cases need what they ask of formats.
    let raw = unsafe { gpu.device().create_image(info, None) };
    let raw = Own::new(gpu, raw.map_err(refused("make an image"))?);
    // SAFETY: the image was just made on this device.
    let wants = unsafe { gpu.device().get_image_memory_requirements(raw.get()) };
    Ok((raw, wants))
}

/// A buffer without memory, and what it wants of some.
pub fn unbound_buffer(
    gpu: &Arc<Gpu>,
    bytes: u64,
    usage: vk::BufferUsageFlags,
) -> Result<(Own<vk::Buffer>, vk::MemoryRequirements), Stop> {
    let info = vk::BufferCreateInfo::default().size(bytes).usage(usage);
    // SAFETY: the device is valid.
    let raw = unsafe { gpu.device().create_buffer(&info, None) };
    let raw = Own::new(gpu, raw.map_err(refused("make a buffer"))?);
    // SAFETY: the buffer was just made on this device.
    let wants = unsafe { gpu.device().get_buffer_memory_requirements(raw.get()) };
    Ok((raw, wants))
}

/// What all of them can be bound to.
pub fn together(wants: impl IntoIterator<Item = vk::MemoryRequirements>) -> vk::MemoryRequirements {
    let start = vk::MemoryRequirements {
        size: 1,
        alignment: 1,
        memory_type_bits: u32::MAX,
    };
    wants
        .into_iter()
        .fold(start, |all, one| vk::MemoryRequirements {
            size: all.size.max(one.size),
            alignment: all.alignment.max(one.alignment),
            memory_type_bits: all.memory_type_bits & one.memory_type_bits,
        })
}

/// Memory for `wants`; `linear` where buffers alone lie in it.
pub fn memory(
    gpu: &Arc<Gpu>,
    wants: vk::MemoryRequirements,
    location: MemoryLocation,
    linear: bool,
) -> Result<OwnMemory, Stop> {
    let scheme = AllocationScheme::GpuAllocatorManaged;
    let desc = AllocationCreateDesc {
        name: "probed",
        requirements: wants,
        location,
        linear,
        allocation_scheme: scheme,
    };
    let doing = || "allocate memory of a probe".to_owned();
    Ok(OwnMemory::new(gpu, &desc, scheme, doing)?)
}

/// Where memory lies.
pub fn place(memory: &OwnMemory) -> (vk::DeviceMemory, u64) {
    let allocation = memory.get();
    // SAFETY: the handle is only bound to, while its owner lives.
    (unsafe { allocation.memory() }, allocation.offset())
}

/// Binds a part of a buffer in place of what is bound to `number`.
pub fn rebind(
    gpu: &Gpu,
    bindings: &Bindings,
    number: u32,
    kind: vk::DescriptorType,
    [offset, range]: [u64; 2],
    buffer: vk::Buffer,
) {
    let info = [vk::DescriptorBufferInfo {
        buffer,
        offset,
        range,
    }];
    let write = [vk::WriteDescriptorSet::default()
        .dst_set(bindings.raw())
        .dst_binding(number)
        .descriptor_type(kind)
        .buffer_info(&info)];
    // SAFETY: the set is in no use yet; the caller gives the binding's own type.
    unsafe { gpu.device().update_descriptor_sets(&write, &[]) };
}

/// Texels of a host: bytes to copy from, and room to copy to.
pub fn copied(gpu: &Arc<Gpu>, bytes: u64, is_from: bool) -> Result<Buffer, Stop> {
    let (usage, memory) = match is_from {
        true => (vk::BufferUsageFlags::TRANSFER_SRC, gpu::Memory::Upload),
        false => (vk::BufferUsageFlags::TRANSFER_DST, gpu::Memory::Readback),
    };
    let bytes = bytes.next_multiple_of(4);
    Ok(Buffer::new(gpu, bytes, usage, memory, "copied")?)
}

/// A pipeline that draws triangles without blending, with a depth of any state.
#[derive(Debug)]
pub struct DepthPipeline {
    raw: Own<vk::Pipeline>,
    layout: Layout,
}

impl DepthPipeline {
    /// Of shaders by name, into a target of four 32-bit floats.
    pub fn new(
        gpu: &Arc<Gpu>,
        [vertex, fragment]: [&str; 2],
        depth_format: vk::Format,
        compare: vk::CompareOp,
        writes: bool,
    ) -> Result<Self, Stop> {
        let (vertex, fragment) = (shader(vertex), shader(fragment));
        let layout = Layout::new(gpu, &[vertex, fragment], fragment.name)?;
        let modules = [module(gpu, vertex)?, module(gpu, fragment)?];
        let stages = [stage(vertex, &modules[0]), stage(fragment, &modules[1])];
        let input = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport = vk::PipelineViewportStateCreateInfo::default()
            .viewport_count(1)
            .scissor_count(1);
        let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
        let samples = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(true)
            .depth_write_enable(writes)
            .depth_compare_op(compare);
        let attachments = [vk::PipelineColorBlendAttachmentState::default()
            .color_write_mask(vk::ColorComponentFlags::RGBA)];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&attachments);
        let dynamic = vk::PipelineDynamicStateCreateInfo::default()
            .dynamic_states(&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR]);
        let colors = [vk::Format::R32G32B32A32_SFLOAT];
        let mut rendering = vk::PipelineRenderingCreateInfo::default()
            .color_attachment_formats(&colors)
            .depth_attachment_format(depth_format);
        let info = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stages)
            .vertex_input_state(&input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&samples)
            .color_blend_state(&blend)
            .depth_stencil_state(&depth)
            .dynamic_state(&dynamic)
            .layout(layout.raw())
            .push_next(&mut rendering);
        let doing = || format!("make raster pipeline `{}`", fragment.name);
        // SAFETY: modules and layout were made of the same shaders.
        let raw = first(gpu, doing, |device| unsafe {
            device.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None)
        })?;
        let raw = Own::new(gpu, raw);
        Ok(Self { raw, layout })
    }

    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// # Safety
    /// `cmd` is recording on the device inside rendering to targets of these formats, with viewport and scissor set;
    /// all that is bound lives until it has run.
    pub unsafe fn draw(&self, cmd: vk::CommandBuffer, bindings: &Bindings, vertices: u32) {
        let point = vk::PipelineBindPoint::GRAPHICS;
        let device = self.raw.gpu().device();
        // SAFETY: the caller's promise.
        unsafe {
            device.cmd_bind_pipeline(cmd, point, self.raw.get());
            let sets = [bindings.raw()];
            device.cmd_bind_descriptor_sets(cmd, point, self.layout.raw(), 0, &sets, &[]);
            device.cmd_draw(cmd, vertices, 1, 0, 0);
        }
    }
}
