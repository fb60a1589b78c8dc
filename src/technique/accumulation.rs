//! The image between a technique and its resolve.

use crate::gpu::{Error, Gpu, Image, ImageDesc, ImageKind};
use ash::vk;
use std::sync::Arc;

/// Four f32 a pixel: accumulation is as exact as the shaders' own arithmetic.
pub const ACCUMULATION_FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// Images in one array that a compute pass fills and a copy fetches.
///
/// # Errors
/// An extent over a limit of the device, no memory.
pub fn accumulations(
    gpu: &Arc<Gpu>,
    [width, height]: [u32; 2],
    count: u32,
    name: &str,
) -> Result<Image, Error> {
    let desc = ImageDesc {
        kind: ImageKind::D2Array,
        extent: [width, height, count],
        format: ACCUMULATION_FORMAT,
        usage: vk::ImageUsageFlags::STORAGE
            | vk::ImageUsageFlags::SAMPLED
            | vk::ImageUsageFlags::TRANSFER_SRC,
        name,
    };
    Image::new(gpu, &desc)
}

/// An image that a compute pass or a slicer fills, a resolve reads, and a copy may fetch.
///
/// # Errors
/// An extent over a limit of the device, no memory.
pub fn accumulation(gpu: &Arc<Gpu>, [width, height]: [u32; 2], name: &str) -> Result<Image, Error> {
    let desc = ImageDesc {
        kind: ImageKind::D2,
        extent: [width, height, 1],
        format: ACCUMULATION_FORMAT,
        usage: vk::ImageUsageFlags::STORAGE
            | vk::ImageUsageFlags::COLOR_ATTACHMENT
            | vk::ImageUsageFlags::SAMPLED
            | vk::ImageUsageFlags::TRANSFER_SRC
            | vk::ImageUsageFlags::TRANSFER_DST,
        name,
    };
    Image::new(gpu, &desc)
}
