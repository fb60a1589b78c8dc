//! A buffer whose later bytes have offsets beyond 32 bits.

use super::{fits, fits::lacking, kit, raw};
use crate::conformance::case::{Case, Profile, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::test_bed::TestBed;
use crate::gpu::owned::{Own, OwnMemory};
use crate::gpu::{Bindings, Buffer, ComputePipeline, Gpu, Headless, Memory, Resource, Use};
use crate::shaders::shader;
use ash::vk;
use gpu_allocator::MemoryLocation;
use std::sync::Arc;

const BEYOND: &str = "Copies to offsets around 4 GiB and a shader that has the bytes from there on bound write where they say: not 4 GiB \
before, which is where offsets of 32 bits lead, and nowhere else.";

const GIB_4: u64 = 1 << 32;
/// The largest range that a binding of every device may have.
const WINDOW_BYTES: u64 = 1 << 27;
const BUFFER_BYTES: u64 = GIB_4 + WINDOW_BYTES;
/// What all words hold at first.
const FILLED: u32 = 0x5a5a_0f0f;
/// Words of a place that is looked at.
const WORDS: usize = 1024;
const PLACE_BYTES: u64 = 4 * WORDS as u64;
/// Around 4 GiB, and where a shader writes: bytes from the beginning of the buffer.
const COPIED: u64 = GIB_4 - PLACE_BYTES / 2;
const SHADED: u64 = GIB_4 + (1 << 20);

/// One.
pub fn cases() -> Vec<Case> {
    let case = Case::new("probe.limits.buffer_beyond_4_gib", measure);
    vec![case.of(Profile::Large)]
}

fn measure(bed: &mut TestBed) -> Result<Measurement, Stop> {
    let mut random = bed.random("beyond");
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let (memory, buffer) = large(&gpu)?;
    let large = buffer.get();
    let brought: Vec<u32> = (0..WORDS).map(|_| random.below(u32::MAX)).collect();
    let bytes: &[u8] = bytemuck::cast_slice(&brought);
    let from = vk::BufferUsageFlags::TRANSFER_SRC;
    let staging = Buffer::new(&gpu, PLACE_BYTES, from, Memory::Upload, "staging")?;
    staging.write(0, bytes)?;
    device.run(|cmd| {
        let copy = [vk::BufferCopy::default()
            .dst_offset(COPIED)
            .size(PLACE_BYTES)];
        // SAFETY: recorded outside rendering, with barriers between; `run` waits, and both live meanwhile.
        unsafe {
            gpu.device()
                .cmd_fill_buffer(cmd, large, 0, vk::WHOLE_SIZE, FILLED);
            barrier(&gpu, cmd, Use::TransferWrite, Use::TransferWrite);
            gpu.device()
                .cmd_copy_buffer(cmd, staging.raw(), large, &copy);
            barrier(&gpu, cmd, Use::TransferWrite, Use::ComputeWrite);
        }
        Ok(())
    })?;
    let shaded = replace(device, &gpu, large)?;
    // The places themselves, where offsets of 32 bits lead, and the end.
    let places = [
        COPIED,
        SHADED,
        0,
        SHADED - GIB_4,
        BUFFER_BYTES - PLACE_BYTES,
    ];
    let found = read_back(device, &gpu, large, &places)?;
    // In this order, and not with its end: memory goes last.
    drop(buffer);
    drop(memory);
    let bound = Bound::new("beyond-4-gib", BEYOND).with("bytes", BUFFER_BYTES as f64);
    let mut measurement = Measurement::new(bound, places.len() * WORDS);
    for (i, [word, count]) in shaded.into_iter().enumerate() {
        let at = || format!("word {i} as the shader reads it");
        measurement.take(at, FILLED.into(), word.into(), 0.0);
        let at = || "the words that the shader counts".to_owned();
        measurement.take(at, (SHADED_BYTES / 4) as f64, count.into(), 0.0);
    }
    for (p, place) in places.iter().enumerate() {
        for i in 0..WORDS {
            let wanted = match p {
                0 => brought[i],
                1 => !FILLED,
                _ => FILLED,
            };
            let at = || format!("word {i} from byte {place}");
            measurement.take(at, wanted.into(), found[p * WORDS + i].into(), 0.0);
        }
    }
    Ok(measurement)
}

/// The buffer, where it fits, with its memory. The library's own are bound whole, which no device allows for so many
/// bytes.
fn large(gpu: &Arc<Gpu>) -> Result<(OwnMemory, Own<vk::Buffer>), Stop> {
    let copied = vk::BufferUsageFlags::TRANSFER_DST | vk::BufferUsageFlags::TRANSFER_SRC;
    let usage = copied | vk::BufferUsageFlags::STORAGE_BUFFER;
    gpu.check_buffer(BUFFER_BYTES, copied, "large")
        .map_err(lacking)?;
    gpu.check_buffer(WINDOW_BYTES, usage, "a part of it")
        .map_err(lacking)?;
    fits::memory(gpu, BUFFER_BYTES)?;
    let (buffer, wants) = raw::unbound_buffer(gpu, BUFFER_BYTES, usage)?;
    let memory = raw::memory(gpu, wants, MemoryLocation::GpuOnly, true)?;
    let (handle, offset) = raw::place(&memory);
    // SAFETY: the memory was allocated for what this buffer wants, and is bound once.
    unsafe {
        gpu.device()
            .bind_buffer_memory(buffer.get(), handle, offset)
    }
    .map_err(raw::refused("bind memory"))?;
    Ok((memory, buffer))
}

/// Orders all that lies before and after.
///
/// # Safety
/// `cmd` is recording on the device, outside rendering.
unsafe fn barrier(gpu: &Gpu, cmd: vk::CommandBuffer, before: Use, after: Use) {
    let [(from, written, _), (to, used, _)] = [before, after].map(Use::state);
    let memory = [vk::MemoryBarrier2::default()
        .src_stage_mask(from)
        .src_access_mask(written)
        .dst_stage_mask(to)
        .dst_access_mask(used)];
    let info = vk::DependencyInfo::default().memory_barriers(&memory);
    // SAFETY: the caller's promise.
    unsafe { gpu.device().cmd_pipeline_barrier2(cmd, &info) };
}

/// What the shader has bound: all from there on.
const SHADED_BYTES: u64 = BUFFER_BYTES - SHADED;

/// Each word of a place becomes its complement; what the shader has read there, and how many words it has bound.
fn replace(
    device: &mut Headless,
    gpu: &Arc<Gpu>,
    large: vk::Buffer,
) -> Result<Vec<[u32; 2]>, Stop> {
    let numbers: Vec<u32> = (0..WORDS as u32).collect();
    let places = kit::buffer(gpu, &numbers, "places")?;
    let found = kit::zeros::<[u32; 2]>(gpu, WORDS, "found")?;
    let pipeline = ComputePipeline::new(gpu, shader("probe/spots"))?;
    // In place of `large`, all of which no binding may have.
    let small = kit::zeros::<u32>(gpu, WORDS, "small")?;
    let resources = [
        ("places", Resource::Storage(&places)),
        ("large", Resource::Storage(&small)),
        ("found", Resource::Storage(&found)),
    ];
    let bindings = Bindings::new(gpu, pipeline.layout(), &resources)?;
    let window = [vk::DescriptorBufferInfo {
        buffer: large,
        offset: SHADED,
        range: SHADED_BYTES,
    }];
    let write = [vk::WriteDescriptorSet::default()
        .dst_set(bindings.raw())
        .dst_binding(1)
        .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
        .buffer_info(&window)];
    // SAFETY: the set is in no use yet; the offset is a multiple of 1 MiB, which is more than any device aligns to, and
    // the range fits a binding.
    unsafe { gpu.device().update_descriptor_sets(&write, &[]) };
    device.run(|cmd| {
        // SAFETY: recorded outside rendering; `run` waits, and all that is bound lives meanwhile.
        unsafe { pipeline.dispatch(cmd, &bindings, &[], [(WORDS / 64) as u32, 1, 1]) };
        Ok(())
    })?;
    kit::read(&found)
}

fn read_back(
    device: &mut Headless,
    gpu: &Arc<Gpu>,
    large: vk::Buffer,
    places: &[u64],
) -> Result<Vec<u32>, Stop> {
    let to = vk::BufferUsageFlags::TRANSFER_DST;
    let bytes = PLACE_BYTES * places.len() as u64;
    let back = Buffer::new(gpu, bytes, to, Memory::Readback, "readback")?;
    device.run(|cmd| {
        let copy = |(i, &place): (usize, &u64)| {
            vk::BufferCopy::default()
                .src_offset(place)
                .dst_offset(PLACE_BYTES * i as u64)
                .size(PLACE_BYTES)
        };
        let copies: Vec<_> = places.iter().enumerate().map(copy).collect();
        // SAFETY: as above.
        unsafe {
            barrier(gpu, cmd, Use::ComputeWrite, Use::TransferRead);
            gpu.device()
                .cmd_copy_buffer(cmd, large, back.raw(), &copies);
        }
        Ok(())
    })?;
    kit::read(&back)
}
