//! Images of many texels: blocks far from one another are what was brought there, and beside them is what the image was
//! cleared to.

use super::kit;
use super::{fits, fits::lacking};
use crate::conformance::case::{Case, Profile, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::test_bed::{Random, TestBed};
use crate::gpu::{
    Buffer, Caps, Headless, Image, ImageDesc, ImageKind, Memory, Region, Resource, Use,
    buffer_to_image, image_barrier, image_to_buffer,
};
use ash::vk;
use std::collections::BTreeMap;
use std::sync::Arc;

const SPARSE: &str = "Blocks of texels at the beginning, the middle and the end of each axis come back as they were brought, by a fetch \
of a shader and by a copy; next to them lies what the image was cleared to.";

const FORMAT: vk::Format = vk::Format::R32_SFLOAT;
const TEXEL_BYTES: u64 = 4;
/// 256 MiB.
const TEXELS: u64 = 1 << 26;
/// Offsets of bytes in it do not fit 32 bits.
const BEYOND_BYTES: u64 = (1 << 32) + (1 << 28);
const CLEARED: f32 = -1.0;
/// Texels of a block, as far as the image goes.
const BLOCK: [u32; 3] = [4, 2, 2];

/// The size for a device; sides that are not the longest follow from it.
type Extent = fn(&Caps) -> [u32; 3];

/// Long along each axis, whole, and beyond 4 GiB.
pub fn cases() -> Vec<Case> {
    use ImageKind::{D2Array, D3};
    use Profile::{Full, Large};
    let all: [(&str, ImageKind, Profile, Extent); 9] = [
        ("2d.width", D2Array, Full, |has| {
            let most = has.max_image_dimension_2d;
            [most, side(TEXELS / u64::from(most), 1, most), 1]
        }),
        ("2d.height", D2Array, Full, |has| {
            let most = has.max_image_dimension_2d;
            [side(TEXELS / u64::from(most), 1, most), most, 1]
        }),
        ("2d_array.layers", D2Array, Full, |has| {
            let most = has.max_image_array_layers;
            let side = side(TEXELS / u64::from(most), 2, has.max_image_dimension_2d);
            [side, side, most]
        }),
        ("3d.width", D3, Full, |has| along(0, has)),
        ("3d.height", D3, Full, |has| along(1, has)),
        ("3d.depth", D3, Full, |has| along(2, has)),
        ("2d.whole", D2Array, Large, |has| {
            [has.max_image_dimension_2d, has.max_image_dimension_2d, 1]
        }),
        ("2d_array.beyond_4_gib", D2Array, Large, |has| {
            let layers = has.max_image_array_layers;
            let texels = BEYOND_BYTES / TEXEL_BYTES / u64::from(layers);
            [side(texels, 2, u32::MAX), side(texels, 2, u32::MAX), layers]
        }),
        ("3d.beyond_4_gib", D3, Large, |_| {
            [side(BEYOND_BYTES / TEXEL_BYTES, 3, u32::MAX); 3]
        }),
    ];
    let case = |(word, kind, profile, extent): (&str, ImageKind, Profile, Extent)| {
        Case::new(format!("probe.limits.large_image_{word}"), move |bed| {
            measure(bed, kind, extent)
        })
        .of(profile)
    };
    all.map(case).into()
}

/// The side of a square or a cube of so many texels or somewhat more.
fn side(texels: u64, power: i32, most: u32) -> u32 {
    let side = (texels as f64).powf(1.0 / f64::from(power)).ceil() as u32;
    side.clamp(1, most)
}

fn along(axis: usize, has: &Caps) -> [u32; 3] {
    let most = has.max_image_dimension_3d;
    let mut extent = [side(TEXELS / u64::from(most), 2, most); 3];
    extent[axis] = most;
    extent
}

/// Where a block begins along an axis: at its beginning, its middle and its end.
fn origins(most: u32, block: u32) -> Vec<u32> {
    match most < 8 * block {
        true => vec![0],
        false => vec![0, most / 2, most - block],
    }
}

fn blocks(extent: [u32; 3]) -> Vec<Region> {
    let size: [u32; 3] = std::array::from_fn(|k| BLOCK[k].min(extent[k]));
    let [x, y, z] = std::array::from_fn(|k| origins(extent[k], size[k]));
    let mut blocks = Vec::new();
    for &z in &z {
        for &y in &y {
            blocks.extend(x.iter().map(|&x| Region {
                origin: [x, y, z],
                extent: size,
            }));
        }
    }
    blocks
}

fn measure(bed: &mut TestBed, kind: ImageKind, extent: Extent) -> Result<Measurement, Stop> {
    let mut random = bed.random("sparse");
    let device = bed.device()?;
    let extent = extent(device.gpu().limits());
    let bytes = TEXEL_BYTES * extent.iter().map(|&n| u64::from(n)).product::<u64>();
    let image = cleared(device, kind, extent, bytes)?;
    let blocks = blocks(extent);
    let brought = brought(&blocks, &mut random);
    let wanted = with_neighbours(&brought, extent);
    let bound = Bound::new("sparse-image", SPARSE)
        .with("width", extent[0].into())
        .with("height", extent[1].into())
        .with("depth", extent[2].into())
        .with("bytes", bytes as f64);
    let mut measurement = Measurement::new(bound, wanted.len());
    bring(device, &image, &blocks, &brought)?;
    let places: Vec<[u32; 4]> = wanted.keys().map(|&[x, y, z]| [x, y, z, 0]).collect();
    let found = fetched(device, kind, &image, &places)?;
    for ((place, &wanted), found) in wanted.iter().zip(found) {
        let at = || format!("texel {place:?} by a fetch");
        measurement.take(at, wanted.into(), found.into(), 0.0);
    }
    let found = copied(device, &image, &blocks)?;
    for ((place, wanted), found) in brought.iter().zip(found) {
        let at = || format!("texel {place:?} by a copy");
        measurement.take(at, f64::from(*wanted), found.into(), 0.0);
    }
    Ok(measurement)
}

/// The image, where it fits, all of one number.
fn cleared(
    device: &mut Headless,
    kind: ImageKind,
    extent: [u32; 3],
    bytes: u64,
) -> Result<Image, Stop> {
    let gpu = Arc::clone(device.gpu());
    let copied = vk::ImageUsageFlags::TRANSFER_DST | vk::ImageUsageFlags::TRANSFER_SRC;
    let desc = ImageDesc {
        kind,
        extent,
        format: FORMAT,
        usage: vk::ImageUsageFlags::SAMPLED | copied,
        name: "large",
    };
    gpu.check_image(&desc).map_err(lacking)?;
    fits::memory(&gpu, bytes)?;
    let image = Image::new(&gpu, &desc)?;
    let color = vk::ClearColorValue {
        float32: [CLEARED; 4],
    };
    let all = [vk::ImageSubresourceRange::default()
        .aspect_mask(vk::ImageAspectFlags::COLOR)
        .level_count(1)
        .layer_count(vk::REMAINING_ARRAY_LAYERS)];
    let layout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
    device.run(|cmd| {
        // SAFETY: recorded outside rendering; `run` waits, and the image lives meanwhile.
        unsafe {
            image_barrier(&gpu, cmd, &image, Use::Nothing, Use::TransferWrite);
            gpu.device()
                .cmd_clear_color_image(cmd, image.raw(), layout, &color, &all);
            // The blocks are written behind it.
            image_barrier(&gpu, cmd, &image, Use::TransferWrite, Use::TransferWrite);
        }
        Ok(())
    })?;
    Ok(image)
}

/// Texels of blocks with the numbers that they get, block by block, x fastest.
fn brought(blocks: &[Region], random: &mut Random) -> Vec<([u32; 3], f32)> {
    let mut texels = Vec::new();
    for Region { origin, extent } in blocks {
        for z in 0..extent[2] {
            for y in 0..extent[1] {
                for x in 0..extent[0] {
                    let place = [origin[0] + x, origin[1] + y, origin[2] + z];
                    texels.push((place, random.below(1 << 23) as f32));
                }
            }
        }
    }
    texels
}

/// The same by their places, and those next to them along each axis.
fn with_neighbours(brought: &[([u32; 3], f32)], extent: [u32; 3]) -> BTreeMap<[u32; 3], f32> {
    let mut wanted = BTreeMap::new();
    for &(place, _) in brought {
        for axis in 0..3 {
            let mut next = place;
            next[axis] = place[axis].wrapping_sub(1);
            let mut other = place;
            other[axis] = place[axis] + 1;
            for beside in [next, other] {
                if beside[axis] < extent[axis] {
                    wanted.insert(beside, CLEARED);
                }
            }
        }
    }
    wanted.extend(brought.iter().copied());
    wanted
}

fn bring(
    device: &mut Headless,
    image: &Image,
    blocks: &[Region],
    brought: &[([u32; 3], f32)],
) -> Result<(), Stop> {
    let gpu = Arc::clone(device.gpu());
    let numbers: Vec<f32> = brought.iter().map(|(_, number)| *number).collect();
    let bytes: &[u8] = bytemuck::cast_slice(&numbers);
    let from = vk::BufferUsageFlags::TRANSFER_SRC;
    let staging = Buffer::new(&gpu, bytes.len() as u64, from, Memory::Upload, "staging")?;
    staging.write(0, bytes)?;
    device.run(|cmd| {
        for (region, offset) in blocks.iter().zip(offsets(blocks)) {
            // SAFETY: as above; the blocks lie apart, and the image is in `TransferWrite`.
            unsafe { buffer_to_image(&gpu, cmd, &staging, offset, image, *region)? };
        }
        // SAFETY: as above.
        unsafe { image_barrier(&gpu, cmd, image, Use::TransferWrite, Use::Sampled) };
        Ok(())
    })?;
    Ok(())
}

/// Where each block begins in a buffer of all of them.
fn offsets(blocks: &[Region]) -> impl Iterator<Item = u64> {
    let bytes = |block: &Region| block.bytes(FORMAT).unwrap_or(0);
    blocks.iter().scan(0, move |offset, block| {
        let at = *offset;
        *offset += bytes(block);
        Some(at)
    })
}

fn fetched(
    device: &mut Headless,
    kind: ImageKind,
    image: &Image,
    places: &[[u32; 4]],
) -> Result<Vec<f32>, Stop> {
    let gpu = Arc::clone(device.gpu());
    let given = kit::buffer(&gpu, places, "places")?;
    let found = kit::zeros::<f32>(&gpu, places.len(), "found")?;
    let resources = [
        ("probed", Resource::sampled(image)),
        ("places", Resource::Storage(&given)),
        ("found", Resource::Storage(&found)),
    ];
    let shader = match kind {
        ImageKind::D3 => "probe/places_3d",
        _ => "probe/places_array",
    };
    let groups = [(places.len() as u32).div_ceil(64), 1, 1];
    kit::compute(device, shader, &resources, groups)?;
    kit::read(&found)
}

fn copied(device: &mut Headless, image: &Image, blocks: &[Region]) -> Result<Vec<f32>, Stop> {
    let gpu = Arc::clone(device.gpu());
    let bytes = blocks.iter().filter_map(|block| block.bytes(FORMAT)).sum();
    let to = vk::BufferUsageFlags::TRANSFER_DST;
    let back = Buffer::new(&gpu, bytes, to, Memory::Readback, "readback")?;
    device.run(|cmd| {
        // SAFETY: as above.
        unsafe { image_barrier(&gpu, cmd, image, Use::Sampled, Use::TransferRead) };
        for (region, offset) in blocks.iter().zip(offsets(blocks)) {
            // SAFETY: as above; each block has a part of the buffer of its own.
            unsafe { image_to_buffer(&gpu, cmd, image, *region, &back, offset)? };
        }
        Ok(())
    })?;
    kit::read(&back)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_lie_apart_and_those_of_a_thin_image_are_few() {
        assert_eq!(blocks([16_384, 4096, 1]).len(), 9);
        assert_eq!(blocks([64, 64, 64]).len(), 27);
        assert_eq!(blocks([31, 2, 1]).len(), 1);
        let mut random = TestBed::without_device(1, |_| unreachable!()).random("");
        let all = brought(&blocks([32, 32, 32]), &mut random);
        let apart: BTreeMap<[u32; 3], f32> = all.iter().copied().collect();
        assert_eq!(apart.len(), all.len());
    }

    #[test]
    fn sizes_are_those_that_are_meant() {
        // 256 texels along each axis.
        assert_eq!(along(2, &Caps::VULKAN_MINIMUM), [256; 3]);
        let side = u64::from(side(BEYOND_BYTES / TEXEL_BYTES, 3, u32::MAX));
        assert!(TEXEL_BYTES * side.pow(3) >= BEYOND_BYTES);
    }
}
