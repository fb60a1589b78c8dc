//! Several things in the same memory, one after the other: how techniques share what they draw into.

use super::kit;
use super::raw::{self, RawImage, State, refused};
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::test_bed::TestBed;
use crate::gpu::owned::{Own, OwnMemory};
use crate::gpu::{Gpu, Headless, Item, Use};
use ash::vk;
use gpu_allocator::MemoryLocation;
use std::sync::Arc;

const BUFFERS: &str = "Two buffers bound to the same memory are the same bytes, once a memory barrier lies between the write by the \
one and the read by the other (Vulkan specification, memory aliasing).";
const IMAGES: &str = "Vulkan specification, memory aliasing: what is written to one of two images in the same memory leaves the other \
undefined. An image that is brought from UNDEFINED behind a barrier, and then written, is what was written.";

/// Buffers, images, one of each.
pub fn cases() -> Vec<Case> {
    let [wide, half] = FORMATS.map(|format| {
        Item::Format(
            format,
            vk::FormatFeatureFlags::TRANSFER_SRC | vk::FormatFeatureFlags::TRANSFER_DST,
        )
    });
    vec![
        Case::new("probe.memory.aliased_buffers", buffers),
        Case::new("probe.memory.aliased_images", images)
            .needing(wide)
            .needing(half),
        Case::new("probe.memory.image_over_buffer", image_over_buffer).needing(wide),
    ]
}

const BYTES: u64 = 4096;
const FORMATS: [vk::Format; 2] = [
    vk::Format::R32G32B32A32_SFLOAT,
    vk::Format::R16G16B16A16_SFLOAT,
];
/// Of the first image, and of the second.
const EXTENTS: [[u32; 3]; 2] = [[64, 48, 1], [96, 64, 1]];

/// Orders all that copies do before and after.
///
/// # Safety
/// `cmd` is recording on the device, outside rendering.
unsafe fn barrier(device: &ash::Device, cmd: vk::CommandBuffer) {
    let (stage, access, _) = Use::TransferWrite.state();
    let access = access | vk::AccessFlags2::TRANSFER_READ;
    let memory = [vk::MemoryBarrier2::default()
        .src_stage_mask(stage)
        .src_access_mask(access)
        .dst_stage_mask(stage)
        .dst_access_mask(access)];
    let info = vk::DependencyInfo::default().memory_barriers(&memory);
    // SAFETY: the caller's promise.
    unsafe { device.cmd_pipeline_barrier2(cmd, &info) };
}

/// Two buffers in the same place of one memory.
fn aliased(gpu: &Arc<Gpu>, bytes: u64) -> Result<([Own<vk::Buffer>; 2], OwnMemory), Stop> {
    let usage = vk::BufferUsageFlags::TRANSFER_DST | vk::BufferUsageFlags::TRANSFER_SRC;
    let (a, wants_a) = raw::unbound_buffer(gpu, bytes, usage)?;
    let (b, wants_b) = raw::unbound_buffer(gpu, bytes, usage)?;
    let wants = raw::together([wants_a, wants_b]);
    let memory = raw::memory(gpu, wants, MemoryLocation::GpuOnly, true)?;
    let (handle, offset) = raw::place(&memory);
    for buffer in [&a, &b] {
        // SAFETY: the memory is of a type that both take, and as large as they want it.
        unsafe {
            gpu.device()
                .bind_buffer_memory(buffer.get(), handle, offset)
        }
        .map_err(refused("bind memory"))?;
    }
    Ok(([a, b], memory))
}

fn buffers(bed: &mut TestBed) -> Result<Measurement, Stop> {
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let (both, _memory) = aliased(&gpu, BYTES)?;
    let back = raw::copied(&gpu, BYTES, false)?;
    let [first, second] = [both[0].get(), both[1].get()];
    let half = BYTES / 2;
    let raw = gpu.device();
    device.run(|cmd| {
        let copy = [vk::BufferCopy::default().size(BYTES)];
        // SAFETY: recorded outside rendering; `run` waits, and all lives meanwhile.
        unsafe {
            raw.cmd_fill_buffer(cmd, first, 0, half, 0x1234_5678);
            barrier(raw, cmd);
            raw.cmd_fill_buffer(cmd, second, half, half, 0x9abc_def0);
            barrier(raw, cmd);
            raw.cmd_copy_buffer(cmd, second, back.raw(), &copy);
        }
        Ok(())
    })?;
    let found: Vec<u32> = kit::read(&back)?;
    let mut measurement = Measurement::new(Bound::new("aliased", BUFFERS), 1000);
    for (i, found) in found.into_iter().enumerate() {
        let wanted: u32 = if i < 512 { 0x1234_5678 } else { 0x9abc_def0 };
        measurement.take(|| format!("word {i}"), wanted.into(), found.into(), 0.0);
    }
    Ok(measurement)
}

fn info(format: vk::Format, [width, height, depth]: [u32; 3]) -> vk::ImageCreateInfo<'static> {
    vk::ImageCreateInfo::default()
        .image_type(vk::ImageType::TYPE_2D)
        .format(format)
        .extent(vk::Extent3D {
            width,
            height,
            depth,
        })
        .mip_levels(1)
        .array_layers(1)
        .samples(vk::SampleCountFlags::TYPE_1)
        .usage(
            vk::ImageUsageFlags::TRANSFER_SRC
                | vk::ImageUsageFlags::TRANSFER_DST
                | vk::ImageUsageFlags::SAMPLED,
        )
}

/// Brings texels to an image that was undefined, and back.
///
/// # Safety
/// `cmd` is recording on the device, outside rendering; what used its memory did so by copies; all live until it has
/// run.
unsafe fn there_and_back(
    gpu: &Gpu,
    cmd: vk::CommandBuffer,
    image: &RawImage,
    extent: [u32; 3],
    [from, back]: [vk::Buffer; 2],
) {
    let raw = gpu.device();
    let (write, read) = (Use::TransferWrite.state(), Use::TransferRead.state());
    let undefined: State = (write.0, write.1, vk::ImageLayout::UNDEFINED);
    let region = [image.whole(extent)];
    // SAFETY: the caller's promise.
    unsafe {
        barrier(raw, cmd);
        image.barrier(cmd, undefined, write);
        raw.cmd_copy_buffer_to_image(cmd, from, image.raw(), write.2, &region);
        image.barrier(cmd, write, read);
        raw.cmd_copy_image_to_buffer(cmd, image.raw(), read.2, back, &region);
    }
}

fn numbers(bed: &TestBed, count: usize) -> Vec<u8> {
    // Bytes of halves and of floats that are numbers, whatever their order.
    let mut random = bed.random("aliased");
    (0..count).map(|_| random.below(120) as u8).collect()
}

fn images(bed: &mut TestBed) -> Result<Measurement, Stop> {
    let bytes = [16, 8].into_iter().zip(EXTENTS);
    let bytes: Vec<usize> = bytes
        .map(|(texel, [w, h, _])| texel * (w * h) as usize)
        .collect();
    let all = numbers(bed, bytes[0] + bytes[1] + bytes[0]);
    let parts = [
        &all[..bytes[0]],
        &all[bytes[0]..bytes[0] + bytes[1]],
        &all[bytes[0] + bytes[1]..],
    ];
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let infos = [0, 1].map(|i| info(FORMATS[i], EXTENTS[i]));
    let (both, _memory) = RawImage::sharing(&gpu, [&infos[0], &infos[1]])?;
    let mut copies = Vec::new();
    for part in parts {
        let from = raw::copied(&gpu, part.len() as u64, true)?;
        from.write(0, part)?;
        copies.push((from, raw::copied(&gpu, part.len() as u64, false)?));
    }
    device.run(|cmd| {
        for (i, (from, back)) in copies.iter().enumerate() {
            let k = i % 2;
            // SAFETY: recorded outside rendering; `run` waits, and all lives meanwhile.
            unsafe {
                let buffers = [from.raw(), back.raw()];
                there_and_back(&gpu, cmd, &both[k], EXTENTS[k], buffers);
            }
        }
        Ok(())
    })?;
    let mut measurement = Measurement::new(Bound::new("aliased-images", IMAGES), 100_000);
    for (turn, (part, (_, back))) in parts.iter().zip(&copies).enumerate() {
        let found: Vec<u8> = kit::read(back)?;
        for (i, (&wanted, found)) in part.iter().zip(found).enumerate() {
            let at = || format!("byte {i} of turn {turn}");
            measurement.take(at, wanted.into(), found.into(), 0.0);
        }
    }
    Ok(measurement)
}

/// A buffer, an image in its place, and the buffer again.
fn image_over_buffer(bed: &mut TestBed) -> Result<Measurement, Stop> {
    let [width, height, _] = EXTENTS[0];
    let bytes = 16 * (width * height) as usize;
    let texels = numbers(bed, bytes);
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let usage = vk::BufferUsageFlags::TRANSFER_DST | vk::BufferUsageFlags::TRANSFER_SRC;
    let (buffer, wants) = raw::unbound_buffer(&gpu, bytes as u64, usage)?;
    let image = info(FORMATS[0], EXTENTS[0]);
    let ([image], memory) = RawImage::sharing_with(&gpu, [&image], wants)?;
    let (handle, offset) = raw::place(&memory);
    // SAFETY: the memory was allocated for what both want.
    unsafe {
        gpu.device()
            .bind_buffer_memory(buffer.get(), handle, offset)
    }
    .map_err(refused("bind memory"))?;
    let from = raw::copied(&gpu, bytes as u64, true)?;
    from.write(0, &texels)?;
    let backs = [0; 3].map(|_| raw::copied(&gpu, bytes as u64, false));
    let [first, second, third] = backs;
    let backs = [first?, second?, third?];
    run_over(device, &gpu, buffer.get(), &image, from.raw(), &backs)?;
    let mut measurement = Measurement::new(Bound::new("aliased-images", IMAGES), 100_000);
    for (turn, back) in backs.iter().enumerate() {
        let found: Vec<u8> = kit::read(back)?;
        for (i, (&texel, found)) in texels.iter().zip(found).enumerate() {
            let wanted = [0x11, texel, 0x22][turn];
            let at = || format!("byte {i} of turn {turn}");
            measurement.take(at, wanted.into(), found.into(), 0.0);
        }
    }
    Ok(measurement)
}

fn run_over(
    device: &mut Headless,
    gpu: &Gpu,
    buffer: vk::Buffer,
    image: &RawImage,
    from: vk::Buffer,
    backs: &[crate::gpu::Buffer; 3],
) -> Result<(), Stop> {
    let raw = gpu.device();
    let bytes = backs[0].bytes();
    let fill = |cmd, word: u32, back: vk::Buffer| {
        let copy = [vk::BufferCopy::default().size(bytes)];
        // SAFETY: recorded outside rendering; `run` waits, and all lives meanwhile.
        unsafe {
            barrier(raw, cmd);
            raw.cmd_fill_buffer(cmd, buffer, 0, bytes, word);
            barrier(raw, cmd);
            raw.cmd_copy_buffer(cmd, buffer, back, &copy);
        }
    };
    device.run(|cmd| {
        fill(cmd, 0x1111_1111, backs[0].raw());
        // SAFETY: as above.
        unsafe { there_and_back(gpu, cmd, image, EXTENTS[0], [from, backs[1].raw()]) };
        fill(cmd, 0x2222_2222, backs[2].raw());
        Ok(())
    })?;
    Ok(())
}
