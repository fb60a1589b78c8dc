//! An image, its memory and its one view.

use super::{Error, Gpu, owned::Own, owned::OwnMemory};
use ash::vk;
use gpu_allocator::{
    MemoryLocation,
    vulkan::{AllocationCreateDesc, AllocationScheme},
};
use std::sync::Arc;

/// What an image is to a shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageKind {
    /// `texture_2d`.
    D2,
    /// `texture_2d_array`; the third number of an extent counts layers.
    D2Array,
    /// `texture_3d`.
    D3,
}

impl ImageKind {
    pub(super) fn image_type(self) -> vk::ImageType {
        match self {
            Self::D2 | Self::D2Array => vk::ImageType::TYPE_2D,
            Self::D3 => vk::ImageType::TYPE_3D,
        }
    }

    fn view_type(self) -> vk::ImageViewType {
        match self {
            Self::D2 => vk::ImageViewType::TYPE_2D,
            Self::D2Array => vk::ImageViewType::TYPE_2D_ARRAY,
            Self::D3 => vk::ImageViewType::TYPE_3D,
        }
    }

    /// How many of `extent[2]` are layers, and how many are depth.
    pub(super) fn layers_and_depth(self, extent: [u32; 3]) -> [u32; 2] {
        match self {
            Self::D2 | Self::D2Array => [extent[2], 1],
            Self::D3 => [1, extent[2]],
        }
    }
}

/// What to make: one mip level, one sample.
#[derive(Clone, Copy, Debug)]
pub struct ImageDesc<'a> {
    /// What the image is to a shader.
    pub kind: ImageKind,
    /// Texels across and down, and the depth, layers, or 1.
    pub extent: [u32; 3],
    /// A color format of [`super::texel_bytes`], or `D32_SFLOAT`.
    pub format: vk::Format,
    /// All that will be done with it.
    pub usage: vk::ImageUsageFlags,
    /// For errors and validation messages.
    pub name: &'a str,
}

/// Images of so many bytes have memory of their own.
const OWN_MEMORY_BYTES: u64 = 1 << 20;

/// An image with memory and a view of all of it.
#[derive(Debug)]
pub struct Image {
    view: Own<vk::ImageView>,
    raw: Own<vk::Image>,
    // After `view` and `raw`: fields are dropped in this order, and memory goes last.
    memory: OwnMemory,
    kind: ImageKind,
    extent: [u32; 3],
    format: vk::Format,
    name: String,
}

impl Image {
    /// An image in layout `UNDEFINED`. Sizes and format are compared with the device first ([`Gpu::check_image`]).
    pub fn new(gpu: &Arc<Gpu>, desc: &ImageDesc<'_>) -> Result<Self, Error> {
        gpu.check_image(desc)?;
        Self::tiled(gpu, desc, vk::ImageTiling::OPTIMAL)
    }

    /// A flat image whose texels the host writes itself, once: `write` gets the bytes of all rows and how many bytes
    /// lie from one row to the next. To be brought from [`super::Use::HostWrite`] into what it is used for.
    ///
    /// # Errors
    /// As [`Image::new`]; where the device has no such images in rows ([`Gpu::has_images_in_rows`]).
    pub fn written_by_host(
        gpu: &Arc<Gpu>,
        desc: &ImageDesc<'_>,
        write: impl FnOnce(&mut [u8], usize),
    ) -> Result<Self, Error> {
        gpu.check_image(desc)?;
        if !gpu.has_images_in_rows(desc) {
            return Err(Error::Format {
                doing: format!("make image `{}` in rows", desc.name),
                format: desc.format,
                lacks: "linear tiling for this usage",
            });
        }
        let made = Self::tiled(gpu, desc, vk::ImageTiling::LINEAR)?;
        let part = vk::ImageSubresource::default().aspect_mask(vk::ImageAspectFlags::COLOR);
        // SAFETY: the image was made on this device, with linear tiling and this one subresource.
        let rows = unsafe { gpu.device().get_image_subresource_layout(made.raw(), part) };
        let allocation = made.memory.get();
        let mapped = allocation.mapped_ptr().expect("asked for so, and coherent");
        // SAFETY: the rows lie inside the memory that is bound to the image; nothing else has the image yet.
        let bytes = unsafe {
            let first = mapped.cast::<u8>().as_ptr().add(rows.offset as usize);
            std::slice::from_raw_parts_mut(first, rows.size as usize)
        };
        write(bytes, rows.row_pitch as usize);
        Ok(made)
    }

    fn tiled(gpu: &Arc<Gpu>, desc: &ImageDesc<'_>, tiling: vk::ImageTiling) -> Result<Self, Error> {
        let is_in_rows = tiling == vk::ImageTiling::LINEAR;
        let doing = || {
            let [width, height, depth] = desc.extent;
            format!(
                "make image `{}` of {width}x{height}x{depth} {:?}",
                desc.name, desc.format
            )
        };
        let [layers, depth] = desc.kind.layers_and_depth(desc.extent);
        let info = vk::ImageCreateInfo::default()
            .image_type(desc.kind.image_type())
            .format(desc.format)
            .extent(vk::Extent3D {
                width: desc.extent[0],
                height: desc.extent[1],
                depth,
            })
            .mip_levels(1)
            .array_layers(layers)
            .samples(vk::SampleCountFlags::TYPE_1)
            .tiling(tiling)
            .initial_layout(match is_in_rows {
                true => vk::ImageLayout::PREINITIALIZED,
                false => vk::ImageLayout::UNDEFINED,
            })
            .usage(desc.usage);
        // SAFETY: the device is valid; sizes, format and usage were checked.
        let raw = gpu.call(doing, |device| unsafe { device.create_image(&info, None) })?;
        let raw = Own::new(gpu, raw);
        gpu.name(raw.get(), desc.name);
        // SAFETY: the image was made on this device.
        let requirements = unsafe { gpu.device().get_image_memory_requirements(raw.get()) };
        let alone = AllocationScheme::DedicatedImage(raw.get());
        let memory = AllocationCreateDesc {
            name: desc.name,
            requirements,
            location: match is_in_rows {
                true => MemoryLocation::CpuToGpu,
                false => MemoryLocation::GpuOnly,
            },
            linear: is_in_rows,
            // Gone with the image: in blocks with small things, places that large ones leave come to pieces.
            allocation_scheme: match requirements.size >= OWN_MEMORY_BYTES {
                true => alone,
                false => AllocationScheme::GpuAllocatorManaged,
            },
        };
        let memory = OwnMemory::new(gpu, &memory, alone, doing)?;
        let allocation = memory.get();
        // SAFETY: the memory was allocated for this image's requirements and is bound once.
        gpu.call(doing, |device| unsafe {
            device.bind_image_memory(raw.get(), allocation.memory(), allocation.offset())
        })?;
        let info = vk::ImageViewCreateInfo::default()
            .image(raw.get())
            .view_type(desc.kind.view_type())
            .format(desc.format)
            .subresource_range(whole(desc.format));
        // SAFETY: the image has memory, and the view is of its own kind and format.
        let view = gpu.call(doing, |device| unsafe {
            device.create_image_view(&info, None)
        })?;
        let view = Own::new(gpu, view);
        gpu.name(view.get(), desc.name);
        Ok(Self {
            view,
            raw,
            memory,
            kind: desc.kind,
            extent: desc.extent,
            format: desc.format,
            name: desc.name.into(),
        })
    }

    /// The Vulkan handle.
    pub fn raw(&self) -> vk::Image {
        self.raw.get()
    }

    /// The view of all of it.
    pub fn view(&self) -> vk::ImageView {
        self.view.get()
    }

    /// What the image is to a shader.
    pub fn kind(&self) -> ImageKind {
        self.kind
    }

    /// Texels across and down, and the depth, layers, or 1.
    pub fn extent(&self) -> [u32; 3] {
        self.extent
    }

    /// The format.
    pub fn format(&self) -> vk::Format {
        self.format
    }

    /// The name in errors and validation messages.
    pub fn name(&self) -> &str {
        &self.name
    }
}

/// Depth attachments of ours: every device has this format or D24, and this one holds what any host's has.
pub const DEPTH_FORMAT: vk::Format = vk::Format::D32_SFLOAT;

/// Every layer of the one level of an image of that format.
pub(super) fn whole(format: vk::Format) -> vk::ImageSubresourceRange {
    match format {
        DEPTH_FORMAT => WHOLE_COLOR.aspect_mask(vk::ImageAspectFlags::DEPTH),
        _ => WHOLE_COLOR,
    }
}

/// Every layer of the one level of a color image.
pub(super) const WHOLE_COLOR: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: vk::REMAINING_ARRAY_LAYERS,
};
