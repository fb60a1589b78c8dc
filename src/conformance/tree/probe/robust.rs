//! The edges of bindings: what a shader reads and writes beyond them, where robust access is enabled.

use super::kit;
use super::raw::{self, rebind};
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::test_bed::TestBed;
use crate::gpu::owned::{Own, OwnMemory};
use crate::gpu::{
    Bindings, ComputePipeline, Feature, Gpu, Headless, Image, ImageDesc, ImageKind, Item,
    ParameterRing, Resource, Use, image_barrier,
};
use crate::shaders::shader;
use ash::vk;
use gpu_allocator::MemoryLocation;
use std::sync::Arc;

const READ: &str = "robustBufferAccess (Vulkan specification, features): a load beyond the bound range gives a number from anywhere in \
the memory that the buffer is bound to, or zero. The buffer's memory holds numbers that no other has.";
const WRITTEN: &str = "robustBufferAccess: a store or an atomic beyond the bound range may change the memory that the buffer is bound to \
and must not change any other. The buffers before and behind it in the same allocation stay as they were.";
const UNIFORM: &str = "A dynamic offset moves the bound range by so many bytes: loads inside are exact. With robustBufferAccess, loads \
beyond give a number of the buffer or zero (of the last channel one, or the largest integer, too).";
const IMAGE: &str = "robustImageAccess (Vulkan 1.3): a load beyond an image gives zeros, and zero or one for alpha; inside of it it is the \
texel, exactly. Stores beyond an image are discarded, with or without.";

/// Buffers, slots of uniforms, images.
pub fn cases() -> Vec<Case> {
    let buffer = Item::Feature(Feature::RobustBufferAccess);
    let image = Item::Feature(Feature::RobustImageAccess);
    vec![
        Case::new("probe.robust.buffer.whole.read", |bed| read(bed, false)).needing(buffer),
        Case::new("probe.robust.buffer.part.read", |bed| read(bed, true)).needing(buffer),
        written("whole.write", "probe/beyond_write", BYTES),
        written("part.write", "probe/beyond_write", BYTES / 2),
        written("whole.atomic", "probe/beyond_atomic", BYTES),
        written("part.atomic", "probe/beyond_atomic", BYTES / 2),
        Case::new("probe.robust.uniform.dynamic_offsets", uniform).needing(buffer),
        Case::new("probe.robust.image.read", image_read).needing(image),
        Case::new("probe.robust.image.write", image_write),
    ]
}

/// What a shader writes beyond so many bytes that are bound.
fn written(word: &str, name: &'static str, range: u64) -> Case {
    let case = Case::new(format!("probe.robust.buffer.{word}"), move |bed| {
        write(bed, name, range)
    });
    case.needing(Item::Feature(Feature::RobustBufferAccess))
}

const BYTES: u64 = 4096;
const WORDS: u32 = (BYTES / 4) as u32;

/// Three buffers, one behind the other in one memory that the host reaches; the middle one is what is bound.
struct Neighbours {
    buffers: [Own<vk::Buffer>; 3],
    // After the buffers: fields are dropped in this order.
    memory: OwnMemory,
    stride: u64,
}

impl Neighbours {
    fn new(gpu: &Arc<Gpu>) -> Result<Self, Stop> {
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let mut made = Vec::new();
        for _ in 0..3 {
            made.push(raw::unbound_buffer(gpu, BYTES, usage)?);
        }
        let one = raw::together(made.iter().map(|(_, wants)| *wants));
        let stride = one.size.next_multiple_of(one.alignment);
        let wants = vk::MemoryRequirements {
            size: 3 * stride,
            ..one
        };
        let memory = raw::memory(gpu, wants, MemoryLocation::CpuToGpu, true)?;
        let (handle, offset) = raw::place(&memory);
        let mut buffers = Vec::new();
        for (i, (buffer, _)) in (0u64..).zip(made) {
            // SAFETY: the memory is of a type that all take, and has room for three.
            unsafe {
                let at = offset + i * stride;
                gpu.device().bind_buffer_memory(buffer.get(), handle, at)
            }
            .map_err(raw::refused("bind memory"))?;
            buffers.push(buffer);
        }
        let buffers = buffers.try_into().expect("three");
        let made = Self {
            buffers,
            memory,
            stride,
        };
        for (i, word) in made.words().iter_mut().enumerate() {
            *word = Self::tag(i as u64 * 4 / stride, i as u64 * 4 % stride);
        }
        Ok(made)
    }

    /// What stands at so many bytes of a buffer.
    fn tag(buffer: u64, bytes: u64) -> u32 {
        (0x1100_0000 * (buffer as u32 + 1)) | (bytes as u32 / 4)
    }

    #[allow(
        clippy::mut_from_ref,
        reason = "the memory is the device's and the host's by turns"
    )]
    fn words(&self) -> &mut [u32] {
        let mapped = self.memory.get().mapped_ptr();
        let first = mapped.expect("asked for so").cast::<u32>().as_ptr();
        // SAFETY: the allocation holds three strides and is coherent; no submission runs while the host looks, and each
        // caller lets go of the words before the next asks.
        unsafe { std::slice::from_raw_parts_mut(first, (3 * self.stride / 4) as usize) }
    }
}

/// Inside, around the end, far beyond: also where four times the place has more than 32 bits.
fn places(bed: &TestBed, end: u32) -> Vec<u32> {
    let mut random = bed.random("robust");
    let mut places: Vec<u32> = (0..end).collect();
    places.extend(end..end + 2048);
    places.extend((0..512).map(|_| random.bits() as u32));
    places.extend([u32::MAX, u32::MAX / 4, 1 << 30, (1 << 30) - 1, 1 << 31]);
    places
}

/// One dispatch of a shader with the middle buffer bound to 1, all of it or its first half.
fn dispatch(
    device: &mut Headless,
    name: &str,
    neighbours: &Neighbours,
    range: u64,
    given: &[(&str, Resource<'_>)],
    count: usize,
) -> Result<(), Stop> {
    let gpu = Arc::clone(device.gpu());
    let pipeline = ComputePipeline::new(&gpu, shader(name))?;
    let bindings = Bindings::new(&gpu, pipeline.layout(), given)?;
    let kind = vk::DescriptorType::STORAGE_BUFFER;
    let bound = neighbours.buffers[1].get();
    rebind(&gpu, &bindings, 1, kind, [0, range], bound);
    let groups = [(count as u32).div_ceil(64), 1, 1];
    device.run(|cmd| {
        // SAFETY: recorded outside rendering; `run` waits, and all that is bound lives meanwhile.
        unsafe { pipeline.dispatch(cmd, &bindings, &[], groups) };
        Ok(())
    })?;
    Ok(())
}

fn read(bed: &mut TestBed, is_part: bool) -> Result<Measurement, Stop> {
    let range = if is_part { BYTES / 2 } else { BYTES };
    let end = (range / 4) as u32;
    let places = places(bed, end);
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let neighbours = Neighbours::new(&gpu)?;
    let given = kit::buffer(&gpu, &places, "places")?;
    let stand_in = kit::zeros::<u32>(&gpu, 4, "stand-in")?;
    let found = kit::zeros::<u32>(&gpu, places.len(), "found")?;
    let resources = [
        ("places", Resource::Storage(&given)),
        ("bound", Resource::Storage(&stand_in)),
        ("found", Resource::Storage(&found)),
    ];
    let name = "probe/beyond_read";
    dispatch(device, name, &neighbours, range, &resources, places.len())?;
    let found: Vec<u32> = kit::read(&found)?;
    let bound = Bound::new("robust-read", READ).with("bytes", range as f64);
    let mut measurement = Measurement::new(bound, 3000);
    for (&place, found) in places.iter().zip(found) {
        let at = || format!("word {place} of {end}");
        match place < end {
            true => {
                let wanted = Neighbours::tag(1, u64::from(place) * 4);
                measurement.take(at, wanted.into(), found.into(), 0.0);
            }
            false => {
                let first = Neighbours::tag(1, 0);
                let is_own = (first..first + (neighbours.stride / 4) as u32).contains(&found);
                measurement.hold(at, found == 0 || is_own);
            }
        }
    }
    Ok(measurement)
}

fn write(bed: &mut TestBed, name: &'static str, range: u64) -> Result<Measurement, Stop> {
    let end = (range / 4) as u32;
    let beyond = places(bed, end).into_iter().filter(|&place| place >= end);
    let places: Vec<u32> = beyond.collect();
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let neighbours = Neighbours::new(&gpu)?;
    let given = kit::buffer(&gpu, &places, "places")?;
    let stand_in = kit::zeros::<u32>(&gpu, 4, "stand-in")?;
    let resources = [
        ("places", Resource::Storage(&given)),
        ("bound", Resource::Storage(&stand_in)),
    ];
    dispatch(device, name, &neighbours, range, &resources, places.len())?;
    let mut measurement = Measurement::new(Bound::new("robust-write", WRITTEN), 2 * WORDS as usize);
    for (i, &found) in neighbours.words().iter().enumerate() {
        let bytes = i as u64 * 4;
        let (buffer, inside) = (bytes / neighbours.stride, bytes % neighbours.stride);
        if buffer != 1 {
            let at = || format!("byte {inside} of neighbour {buffer}");
            let wanted = Neighbours::tag(buffer, inside);
            measurement.take(at, wanted.into(), found.into(), 0.0);
        }
    }
    Ok(measurement)
}

fn uniform(bed: &mut TestBed) -> Result<Measurement, Stop> {
    const SLOTS: u32 = 8;
    const INSIDE: u32 = 16;
    let mut random = bed.random("robust.uniform");
    let mut places: Vec<u32> = (0..2 * INSIDE).collect();
    places.extend((0..96).map(|_| random.bits() as u32 >> random.below(28)));
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let ring = ParameterRing::new(&gpu, 16 * INSIDE, SLOTS, "slots")?;
    let tag = |slot: u32, word: u32| 0x2200_0000 | slot << 16 | word;
    for slot in 0..SLOTS {
        let words: Vec<u32> = (0..4 * INSIDE).map(|word| tag(slot, word)).collect();
        ring.write(slot, bytemuck::cast_slice(&words))?;
    }
    let given = kit::buffer(&gpu, &places, "places")?;
    let pipeline = ComputePipeline::new(&gpu, shader("probe/beyond_uniform"))?;
    let bound = Bound::new("robust-uniform", UNIFORM);
    let mut measurement = Measurement::new(bound, 500);
    for slot in 0..SLOTS {
        let found = kit::zeros::<[u32; 4]>(&gpu, places.len(), "found")?;
        let resources = [
            ("slot", Resource::Uniform(&ring)),
            ("places", Resource::Storage(&given)),
            ("found", Resource::Storage(&found)),
        ];
        let bindings = Bindings::new(&gpu, pipeline.layout(), &resources)?;
        let offset = ring.offset(slot)?;
        device.run(|cmd| {
            // SAFETY: as above; the offset is one of the ring's.
            unsafe { pipeline.dispatch(cmd, &bindings, &[offset], [2, 1, 1]) };
            Ok(())
        })?;
        let found: Vec<[u32; 4]> = kit::read(&found)?;
        for (&place, found) in places.iter().zip(found) {
            for (channel, found) in (0u32..).zip(found) {
                let at = || format!("channel {channel} of word {place} of slot {slot}");
                if place < INSIDE {
                    let wanted = tag(slot, 4 * place + channel);
                    measurement.take(at, wanted.into(), found.into(), 0.0);
                    continue;
                }
                let is_own = found >> 24 == 0x22 || found == 0;
                let is_last = channel == 3 && [1, i32::MAX as u32, u32::MAX].contains(&found);
                measurement.hold(at, is_own || is_last);
            }
        }
    }
    Ok(measurement)
}

const SIDES: [i32; 3] = [8, 6, 5];

/// Inside of an image, around its edges and far away.
fn texel_places(bed: &TestBed) -> Vec<[i32; 4]> {
    let mut random = bed.random("robust.image");
    let mut places = Vec::new();
    for z in -2..SIDES[2] + 2 {
        for y in -2..SIDES[1] + 2 {
            places.extend((-2..SIDES[0] + 2).map(|x| [x, y, z, 0]));
        }
    }
    places.extend((0..256).map(|_| [0; 4].map(|_| random.bits() as i32 >> random.below(24))));
    places
}

fn is_inside(place: [i32; 4], axes: usize) -> bool {
    (0..axes).all(|k| (0..SIDES[k]).contains(&place[k]))
}

fn image_read(bed: &mut TestBed) -> Result<Measurement, Stop> {
    let places = texel_places(bed);
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let format = vk::Format::R32G32B32A32_SFLOAT;
    let [width, height, depth] = SIDES.map(|n| n as u32);
    let number = |i: u32| 1.0 + i as f32;
    let texels: Vec<f32> = (0..4 * width * height * depth).map(number).collect();
    let bytes = bytemuck::cast_slice(&texels);
    let extent = [width, height, depth];
    let probed = kit::image(device, ImageKind::D3, extent, format, bytes)?;
    let flat = stored_image(device, &texels[..(4 * width * height) as usize])?;
    let given = kit::buffer(&gpu, &places, "places")?;
    let found = kit::zeros::<[[f32; 4]; 2]>(&gpu, places.len(), "found")?;
    let resources = [
        ("probed", Resource::sampled(&probed)),
        ("loaded", Resource::read(&flat)),
        ("places", Resource::Storage(&given)),
        ("found", Resource::Storage(&found)),
    ];
    let groups = [(places.len() as u32).div_ceil(64), 1, 1];
    kit::compute(device, "probe/beyond_fetch", &resources, groups)?;
    let found: Vec<[[f32; 4]; 2]> = kit::read(&found)?;
    let mut measurement = Measurement::new(Bound::new("robust-image", IMAGE), 4000);
    for (&place, found) in places.iter().zip(found) {
        for (axes, found) in [3, 2].into_iter().zip(found) {
            let [x, y, z, _] = place;
            let at = |c: usize| format!("channel {c} of texel {place:?} of {axes} axes");
            for (c, found) in found.into_iter().enumerate() {
                if is_inside(place, axes) {
                    let layer = if axes == 3 { z } else { 0 };
                    let index = x + SIDES[0] * (y + SIDES[1] * layer);
                    let wanted = number(4 * index as u32 + c as u32);
                    measurement.take(|| at(c), wanted.into(), found.into(), 0.0);
                } else {
                    let is_one = c == 3 && found == 1.0;
                    measurement.hold(|| at(c), found == 0.0 || is_one);
                }
            }
        }
    }
    Ok(measurement)
}

/// A storage image of two axes with these texels, in [`Use::ComputeWrite`].
fn stored_image(device: &mut Headless, texels: &[f32]) -> Result<Image, Stop> {
    let gpu = Arc::clone(device.gpu());
    let desc = ImageDesc {
        kind: ImageKind::D2,
        extent: [SIDES[0] as u32, SIDES[1] as u32, 1],
        format: vk::Format::R32G32B32A32_SFLOAT,
        usage: vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::TRANSFER_SRC,
        name: "stored",
    };
    let image = Image::new(&gpu, &desc)?;
    device.run(|cmd| {
        // SAFETY: recorded outside rendering; `run` waits.
        unsafe { image_barrier(&gpu, cmd, &image, Use::Nothing, Use::ComputeWrite) };
        Ok(())
    })?;
    let given = kit::buffer(&gpu, texels, "numbers")?;
    let resources = [
        ("stored", Resource::written(&image)),
        ("numbers", Resource::Storage(&given)),
    ];
    kit::compute(device, "probe/store.rgba32float", &resources, [1, 1, 1])?;
    device.run(|cmd| {
        // SAFETY: as above.
        unsafe { image_barrier(&gpu, cmd, &image, Use::ComputeWrite, Use::ComputeWrite) };
        Ok(())
    })?;
    Ok(image)
}

fn image_write(bed: &mut TestBed) -> Result<Measurement, Stop> {
    let all = texel_places(bed).into_iter();
    let places: Vec<[i32; 4]> = all.filter(|&place| !is_inside(place, 2)).collect();
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let count = 4 * SIDES[0] * SIDES[1];
    let texels: Vec<f32> = (0..count).map(|i| 100.0 + i as f32).collect();
    let image = stored_image(device, &texels)?;
    let given = kit::buffer(&gpu, &places, "places")?;
    let resources = [
        ("stored", Resource::written(&image)),
        ("places", Resource::Storage(&given)),
    ];
    let groups = [(places.len() as u32).div_ceil(64), 1, 1];
    kit::compute(device, "probe/beyond_store", &resources, groups)?;
    let found = kit::texels(device, &image, Use::ComputeWrite)?;
    let mut measurement = Measurement::new(Bound::new("robust-image", IMAGE), count as usize);
    for (i, &wanted) in texels.iter().enumerate() {
        let found = kit::number(vk::Format::R32G32B32A32_SFLOAT, &found, i);
        measurement.take(|| format!("number {i}"), wanted.into(), found, 0.0);
    }
    Ok(measurement)
}
