//! How a shader reads between texels, and beyond the edge.

use super::{Error, Gpu, owned::Own};
use ash::vk;
use std::sync::Arc;

/// A sampler for normalized coordinates; beyond the edge the edge's texel counts.
#[derive(Debug)]
pub struct Sampler {
    raw: Own<vk::Sampler>,
}

impl Sampler {
    /// Linear between texel centres. The format must allow it: [`Gpu::format_features`].
    pub fn linear_clamp(gpu: &Arc<Gpu>) -> Result<Self, Error> {
        Self::new(gpu, vk::Filter::LINEAR, "linear clamp")
    }

    /// The texel that the position lies in.
    pub fn nearest_clamp(gpu: &Arc<Gpu>) -> Result<Self, Error> {
        Self::new(gpu, vk::Filter::NEAREST, "nearest clamp")
    }

    fn new(gpu: &Arc<Gpu>, filter: vk::Filter, name: &str) -> Result<Self, Error> {
        let clamp = vk::SamplerAddressMode::CLAMP_TO_EDGE;
        let info = vk::SamplerCreateInfo::default()
            .mag_filter(filter)
            .min_filter(filter)
            .mipmap_mode(vk::SamplerMipmapMode::NEAREST)
            .address_mode_u(clamp)
            .address_mode_v(clamp)
            .address_mode_w(clamp);
        // SAFETY: the device is valid and these modes need no feature.
        let raw = gpu.call(
            || format!("make sampler `{name}`"),
            |device| unsafe { device.create_sampler(&info, None) },
        )?;
        gpu.name(raw, name);
        Ok(Self {
            raw: Own::new(gpu, raw),
        })
    }

    /// The Vulkan handle.
    pub fn raw(&self) -> vk::Sampler {
        self.raw.get()
    }
}
