//! Sizes compared with the limits of the device before anything is created.

use super::{Error, Gpu, ImageDesc, ImageKind, error::Doing, error::within, texel_bytes};
use ash::vk;

/// An image of ours has a view, which Vulkan allows for these usages.
const VIEWED: vk::ImageUsageFlags = vk::ImageUsageFlags::from_raw(
    vk::ImageUsageFlags::SAMPLED.as_raw()
        | vk::ImageUsageFlags::STORAGE.as_raw()
        | vk::ImageUsageFlags::COLOR_ATTACHMENT.as_raw()
        | vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT.as_raw(),
);

impl Gpu {
    /// Refuses a buffer that this device cannot hold or bind whole with this usage.
    pub fn check_buffer(
        &self,
        bytes: u64,
        usage: vk::BufferUsageFlags,
        name: &str,
    ) -> Result<(), Error> {
        let doing = || format!("make buffer `{name}`");
        let limits = self.limits();
        if bytes == 0 {
            return Err(Error::Argument {
                doing: doing(),
                wanted: "1 byte or more".into(),
                found: "0".into(),
            });
        }
        if usage.contains(vk::BufferUsageFlags::STORAGE_BUFFER) {
            within(
                doing,
                "maxStorageBufferRange",
                bytes,
                limits.max_storage_buffer_range.into(),
            )?;
        }
        within(doing, "maxBufferSize", bytes, limits.max_buffer_bytes)?;
        within(
            doing,
            "maxMemoryAllocationSize",
            bytes,
            limits.max_allocation_bytes,
        )?;
        within(
            doing,
            "the largest memory heap",
            bytes,
            limits.max_heap_bytes,
        )
    }

    /// Refuses an image that this device cannot hold: its extent, its layers, its format with this usage,
    /// its texels compared with the largest resource, allocation and heap.
    pub fn check_image(&self, desc: &ImageDesc<'_>) -> Result<(), Error> {
        let doing = || format!("make image `{}`", desc.name);
        let limits = self.limits();
        let [width, height, depth] = desc.extent;
        let is_flat = desc.kind == ImageKind::D2;
        if width == 0 || height == 0 || depth == 0 || is_flat && depth != 1 {
            return Err(Error::Argument {
                doing: doing(),
                wanted: if is_flat {
                    "an extent WxHx1"
                } else {
                    "an extent without a zero"
                }
                .into(),
                found: format!("{width}x{height}x{depth}"),
            });
        }
        if !desc.usage.intersects(VIEWED) {
            return Err(Error::Argument {
                doing: doing(),
                wanted: "a usage that needs a view: sampled, storage, color or depth".into(),
                found: "none of them".into(),
            });
        }
        let (side_limit, side_allowed) = match desc.kind {
            ImageKind::D3 => ("maxImageDimension3D", limits.max_image_dimension_3d),
            _ => ("maxImageDimension2D", limits.max_image_dimension_2d),
        };
        within(
            doing,
            side_limit,
            width.max(height).into(),
            side_allowed.into(),
        )?;
        match desc.kind {
            ImageKind::D3 => within(doing, side_limit, depth.into(), side_allowed.into())?,
            _ => within(
                doing,
                "maxImageArrayLayers",
                depth.into(),
                limits.max_image_array_layers.into(),
            )?,
        }
        let attached =
            vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
        if desc.usage.intersects(attached) {
            within(
                doing,
                "maxFramebufferWidth",
                width.into(),
                limits.max_framebuffer[0].into(),
            )?;
            within(
                doing,
                "maxFramebufferHeight",
                height.into(),
                limits.max_framebuffer[1].into(),
            )?;
        }
        let texel_bytes = texel_bytes(desc.format).ok_or_else(|| Error::Format {
            doing: doing(),
            format: desc.format,
            lacks: "known texel size",
        })?;
        // Each side was compared with a limit of 32 bits, so u128 cannot overflow and the error shows the true number.
        let bytes = [width, height, depth, texel_bytes]
            .iter()
            .map(|&n| u128::from(n))
            .product::<u128>();
        let bytes = u64::try_from(bytes).unwrap_or(u64::MAX);
        let possible = self.image_format_properties(desc, vk::ImageTiling::OPTIMAL)?;
        let max_extent = possible.max_extent;
        within(
            doing,
            "maxExtent.width of this format",
            width.into(),
            max_extent.width.into(),
        )?;
        within(
            doing,
            "maxExtent.height of this format",
            height.into(),
            max_extent.height.into(),
        )?;
        match desc.kind {
            ImageKind::D3 => within(
                doing,
                "maxExtent.depth of this format",
                depth.into(),
                max_extent.depth.into(),
            )?,
            _ => {
                let allowed = possible.max_array_layers.into();
                within(
                    doing,
                    "maxArrayLayers of this format",
                    depth.into(),
                    allowed,
                )?;
            }
        }
        let max_resource_bytes = possible.max_resource_size.min(limits.max_resource_bytes);
        within(doing, "maxResourceSize", bytes, max_resource_bytes)?;
        within(
            doing,
            "maxMemoryAllocationSize",
            bytes,
            limits.max_allocation_bytes,
        )?;
        within(
            doing,
            "the largest memory heap",
            bytes,
            limits.max_heap_bytes,
        )
    }

    /// Whether there are images of one layer of this kind whose rows the host reaches (linear tiling).
    pub fn has_images_in_rows(&self, desc: &ImageDesc<'_>) -> bool {
        let possible = self.image_format_properties(desc, vk::ImageTiling::LINEAR);
        possible.is_ok_and(|possible| {
            let most = possible.max_extent;
            desc.kind == ImageKind::D2
                && desc.extent[0] <= most.width
                && desc.extent[1] <= most.height
        })
    }

    fn image_format_properties(
        &self,
        desc: &ImageDesc<'_>,
        tiling: vk::ImageTiling,
    ) -> Result<vk::ImageFormatProperties, Error> {
        let doing = || format!("make image `{}`", desc.name);
        let info = vk::PhysicalDeviceImageFormatInfo2::default()
            .format(desc.format)
            .ty(desc.kind.image_type())
            .tiling(tiling)
            .usage(desc.usage);
        let mut properties = vk::ImageFormatProperties2::default();
        // SAFETY: the physical device belongs to the instance; both live as long as we do.
        let found = unsafe {
            self.instance()
                .get_physical_device_image_format_properties2(
                    self.physical_device(),
                    &info,
                    &mut properties,
                )
        };
        match found {
            Ok(()) => Ok(properties.image_format_properties),
            Err(vk::Result::ERROR_FORMAT_NOT_SUPPORTED) => Err(Error::Format {
                doing: doing(),
                format: desc.format,
                lacks: "image with the wanted usage",
            }),
            Err(result) => Err(result).doing(doing),
        }
    }
}
