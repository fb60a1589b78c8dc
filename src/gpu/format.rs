//! Texel formats: their size, and what a device can do with them.

use super::Gpu;
use ash::vk;

/// What a device can do with optimally tiled images of one format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FormatFeatures {
    /// A shader can read it.
    pub sampled: bool,
    /// A sampler can filter it linearly.
    pub linear: bool,
    /// A shader can write it.
    pub storage: bool,
    /// It can be a color target.
    pub color: bool,
    /// It can be a color target that is blended into.
    pub blend: bool,
    /// It can be a depth attachment.
    pub depth: bool,
}

impl Gpu {
    /// What this device can do with `format`.
    pub fn format_features(&self, format: vk::Format) -> FormatFeatures {
        // SAFETY: the physical device belongs to the instance; both live as long as we do.
        let features =
            unsafe { FormatFeatures::of(self.instance(), self.physical_device(), format) };
        let is_clamped = format == vk::Format::R32G32B32A32_SFLOAT && !self.limits().float32_blend;
        FormatFeatures {
            blend: features.blend && !is_clamped,
            ..features
        }
    }
}

impl FormatFeatures {
    /// # Safety
    /// `physical_device` belongs to `instance`.
    pub(super) unsafe fn of(
        instance: &ash::Instance,
        physical_device: vk::PhysicalDevice,
        format: vk::Format,
    ) -> Self {
        use vk::FormatFeatureFlags as Flags;
        // SAFETY: the caller's promise.
        let properties =
            unsafe { instance.get_physical_device_format_properties(physical_device, format) };
        let has = |flags| properties.optimal_tiling_features.contains(flags);
        Self {
            sampled: has(Flags::SAMPLED_IMAGE),
            linear: has(Flags::SAMPLED_IMAGE | Flags::SAMPLED_IMAGE_FILTER_LINEAR),
            storage: has(Flags::STORAGE_IMAGE),
            color: has(Flags::COLOR_ATTACHMENT),
            blend: has(Flags::COLOR_ATTACHMENT_BLEND),
            depth: has(Flags::DEPTH_STENCIL_ATTACHMENT),
        }
    }
}

/// Bytes of one texel; `None` for compressed, packed-plane and other formats that we never make.
pub fn texel_bytes(format: vk::Format) -> Option<u32> {
    use vk::Format as F;
    Some(match format {
        F::R8_UNORM | F::R8_SNORM | F::R8_UINT | F::R8_SINT => 1,
        F::R8G8_UNORM | F::R8G8_SNORM | F::R8G8_UINT | F::R8G8_SINT => 2,
        F::R16_UNORM | F::R16_SNORM | F::R16_UINT | F::R16_SINT | F::R16_SFLOAT => 2,
        F::R8G8B8A8_UNORM | F::R8G8B8A8_SRGB | F::R8G8B8A8_SNORM => 4,
        F::R8G8B8A8_UINT | F::R8G8B8A8_SINT => 4,
        F::B8G8R8A8_UNORM | F::B8G8R8A8_SRGB => 4,
        F::A2B10G10R10_UNORM_PACK32 | F::B10G11R11_UFLOAT_PACK32 => 4,
        F::R16G16_UNORM | F::R16G16_SNORM | F::R16G16_SFLOAT => 4,
        F::R32_UINT | F::R32_SINT | F::R32_SFLOAT | F::D32_SFLOAT => 4,
        F::R16G16B16A16_UNORM | F::R16G16B16A16_SNORM | F::R16G16B16A16_SFLOAT => 8,
        F::R16G16B16A16_UINT | F::R16G16B16A16_SINT => 8,
        F::R32G32_UINT | F::R32G32_SINT | F::R32G32_SFLOAT => 8,
        F::R32G32B32A32_UINT | F::R32G32B32A32_SINT | F::R32G32B32A32_SFLOAT => 16,
        _ => return None,
    })
}
