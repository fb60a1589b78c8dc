//! The largest buffer that fits, and dispatches of many workgroups.

use super::kit;
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::test_bed::TestBed;
use crate::gpu::{Buffer, Memory, Resource, Use, buffer_barrier};
use ash::vk;
use std::sync::Arc;

const BUFFER: &str = "A storage buffer of maxStorageBufferRange bytes, or of an eighth of the largest heap, of the largest allocation or \
of the largest buffer where that is less: words at its start, its middle and its end are those that are there, and no others.";
const MANY: &str = "Each workgroup runs once (Vulkan specification, dispatching): each bit is flipped once, and the counter counts all.";

/// Both.
pub fn cases() -> Vec<Case> {
    vec![
        Case::new("probe.limits.storage_buffer", buffer),
        Case::new("probe.compute.dispatch.many", many),
    ]
}

/// What all words hold at first.
const FILLED: u32 = 0x5a5a_0f0f;

fn buffer(bed: &mut TestBed) -> Result<Measurement, Stop> {
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let limits = gpu.limits();
    let most = u64::from(limits.max_storage_buffer_range)
        .min(limits.max_heap_bytes / 8)
        .min(limits.max_buffer_bytes)
        .min(limits.max_allocation_bytes);
    let words = most / 4;
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER
        | vk::BufferUsageFlags::TRANSFER_DST
        | vk::BufferUsageFlags::TRANSFER_SRC;
    let large = Buffer::new(&gpu, 4 * words, usage, Memory::Device, "large")?;
    // 1024 words at the start, in the middle and at the end.
    let spots = [0, words / 2, words - 1024];
    let places: Vec<u32> = spots
        .iter()
        .flat_map(|&first| (0..1024).step_by(3).map(move |i| (first + i) as u32))
        .collect();
    let given = kit::buffer(&gpu, &places, "places")?;
    let found = kit::zeros::<[u32; 2]>(&gpu, places.len(), "found")?;
    let to = vk::BufferUsageFlags::TRANSFER_DST;
    let back = Buffer::new(&gpu, 3 * 4096, to, Memory::Readback, "readback")?;
    device.run(|cmd| {
        // SAFETY: recorded outside rendering; `run` waits, and the buffer lives meanwhile.
        unsafe {
            gpu.device()
                .cmd_fill_buffer(cmd, large.raw(), 0, vk::WHOLE_SIZE, FILLED);
            buffer_barrier(&gpu, cmd, &large, Use::TransferWrite, Use::ComputeWrite);
        }
        Ok(())
    })?;
    let resources = [
        ("places", Resource::Storage(&given)),
        ("large", Resource::Storage(&large)),
        ("found", Resource::Storage(&found)),
    ];
    let groups = [(places.len() as u32).div_ceil(64), 1, 1];
    kit::compute(device, "probe/spots", &resources, groups)?;
    device.run(|cmd| {
        let copy = |i: usize| {
            vk::BufferCopy::default()
                .src_offset(4 * spots[i])
                .dst_offset(4096 * i as u64)
                .size(4096)
        };
        let copies = [0, 1, 2].map(copy);
        // SAFETY: as above.
        unsafe {
            buffer_barrier(&gpu, cmd, &large, Use::ComputeWrite, Use::TransferRead);
            gpu.device()
                .cmd_copy_buffer(cmd, large.raw(), back.raw(), &copies);
        }
        Ok(())
    })?;
    let bound = Bound::new("largest-buffer", BUFFER).with("bytes", most as f64);
    let mut measurement = Measurement::new(bound, 4000);
    let found: Vec<[u32; 2]> = kit::read(&found)?;
    for (place, [word, count]) in places.iter().zip(found) {
        let at = || format!("word {place} as the shader reads it");
        measurement.take(at, FILLED.into(), word.into(), 0.0);
        let at = || "the words that the shader counts".to_owned();
        measurement.take(at, words as f64, count.into(), 0.0);
    }
    let after: Vec<u32> = kit::read(&back)?;
    for (i, found) in after.into_iter().enumerate() {
        let is_replaced = (i % 1024).is_multiple_of(3);
        let wanted = if is_replaced { !FILLED } else { FILLED };
        let at = || format!("word {} of part {}", i % 1024, i / 1024);
        measurement.take(at, wanted.into(), found.into(), 0.0);
    }
    Ok(measurement)
}

fn many(bed: &mut TestBed) -> Result<Measurement, Stop> {
    // Two million workgroups along three axes.
    const GROUPS: [u32; 3] = [512, 128, 32];
    let count = GROUPS.iter().product::<u32>();
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let bits = kit::zeros::<u32>(&gpu, count as usize / 32, "bits")?;
    let counter = kit::zeros::<u32>(&gpu, 1, "counter")?;
    let resources = [
        ("bits", Resource::Storage(&bits)),
        ("counter", Resource::Storage(&counter)),
    ];
    kit::compute(device, "probe/many", &resources, GROUPS)?;
    let bound = Bound::new("many-workgroups", MANY).with("workgroups", count.into());
    let mut measurement = Measurement::new(bound, count as usize / 32);
    let found: Vec<u32> = kit::read(&counter)?;
    let at = || "the count".to_owned();
    measurement.take(at, count.into(), found[0].into(), 0.0);
    let found: Vec<u32> = kit::read(&bits)?;
    for (i, found) in found.into_iter().enumerate() {
        let at = || format!("bits of the 32 workgroups from {}", 32 * i);
        measurement.take(at, u32::MAX.into(), found.into(), 0.0);
    }
    Ok(measurement)
}
