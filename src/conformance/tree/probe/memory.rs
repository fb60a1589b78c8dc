//! Timeline semaphores, and two buffers in the same memory.

use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::stand::Stand;
use crate::gpu::{self, Buffer, Feature, Gpu, Item, Memory, Use};
use ash::vk;
use std::sync::Arc;

const TIMELINE: &str = "The Vulkan specification says what the counter of a timeline semaphore is after each signal, and that a wait \
ends when its value is reached and not before.";
const ALIASED: &str = "Two buffers bound to the same memory are the same bytes, once a memory barrier lies between the write by the \
one and the read by the other (Vulkan specification, memory aliasing).";

/// Both.
pub fn cases() -> Vec<Case> {
    let timeline = Case::new("probe.timeline_semaphore", timeline);
    vec![
        timeline.needing(Item::Feature(Feature::TimelineSemaphore)),
        Case::new("probe.memory.aliased_buffers", aliased),
    ]
}

fn refused(doing: &str) -> impl Fn(vk::Result) -> Stop {
    move |result| {
        let doing = doing.to_owned();
        match result {
            vk::Result::ERROR_DEVICE_LOST => gpu::Error::DeviceLost { doing }.into(),
            vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => gpu::Error::OutOfMemory {
                doing,
                memory: "device",
            }
            .into(),
            result => gpu::Error::Vulkan { doing, result }.into(),
        }
    }
}

fn timeline(stand: &mut Stand) -> Result<Measurement, Stop> {
    let device = stand.device()?;
    let gpu = Arc::clone(device.gpu());
    let mut kind = vk::SemaphoreTypeCreateInfo::default()
        .semaphore_type(vk::SemaphoreType::TIMELINE)
        .initial_value(5);
    let info = vk::SemaphoreCreateInfo::default().push_next(&mut kind);
    // SAFETY: the feature is a need of this case.
    let semaphore = unsafe { gpu.device().create_semaphore(&info, None) };
    let semaphore = semaphore.map_err(refused("make a semaphore"))?;
    let asked = ask_timeline(&gpu, semaphore);
    // SAFETY: nothing that was submitted is unfinished, and the semaphore is ours.
    unsafe {
        let _ = gpu.device().device_wait_idle();
        gpu.device().destroy_semaphore(semaphore, None);
    }
    asked
}

fn ask_timeline(gpu: &Gpu, semaphore: vk::Semaphore) -> Result<Measurement, Stop> {
    const SECONDS: u64 = 10_000_000_000;
    let device = gpu.device();
    let mut measurement = Measurement::new(Bound::new("timeline", TIMELINE), 8);
    let semaphores = [semaphore];
    let counter = || {
        // SAFETY: a timeline of this device, here and below.
        unsafe { device.get_semaphore_counter_value(semaphore) }.map_err(refused("read a counter"))
    };
    let reached = |value: u64, time: u64| {
        let values = [value];
        let info = vk::SemaphoreWaitInfo::default()
            .semaphores(&semaphores)
            .values(&values);
        // SAFETY: as above.
        match unsafe { device.wait_semaphores(&info, time) } {
            Ok(()) => Ok(true),
            Err(vk::Result::TIMEOUT) => Ok(false),
            Err(result) => Err(refused("wait for a semaphore")(result)),
        }
    };
    let signal = |value: u64| {
        let info = vk::SemaphoreSignalInfo::default()
            .semaphore(semaphore)
            .value(value);
        // SAFETY: as above; values rise.
        unsafe { device.signal_semaphore(&info) }.map_err(refused("signal a semaphore"))
    };
    measurement.hold(|| "the counter starts at 5".into(), counter()? == 5);
    signal(7)?;
    measurement.hold(|| "the host signals 7".into(), counter()? == 7);
    measurement.hold(|| "7 is reached".into(), reached(7, SECONDS)?);
    measurement.hold(|| "8 is not".into(), !reached(8, 0)?);
    let point = |value: u64| {
        vk::SemaphoreSubmitInfo::default()
            .semaphore(semaphore)
            .value(value)
            .stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
    };
    let (waits, signals) = ([point(8)], [point(9)]);
    let submit = [vk::SubmitInfo2::default()
        .wait_semaphore_infos(&waits)
        .signal_semaphore_infos(&signals)];
    // SAFETY: the one queue of a device of ours, which nobody else uses meanwhile; synchronization2 is required.
    let submitted = unsafe {
        let queue = device.get_device_queue(gpu.queue_family(), 0);
        device.queue_submit2(queue, &submit, vk::Fence::null())
    };
    submitted.map_err(refused("submit"))?;
    measurement.hold(
        || "what waits for 8 has not signalled 9".into(),
        !reached(9, 20_000_000)?,
    );
    signal(8)?;
    measurement.hold(|| "9 follows 8".into(), reached(9, SECONDS)?);
    measurement.hold(|| "the counter ends at 9".into(), counter()? == 9);
    measurement.hold(|| "what was reached stays so".into(), reached(5, 0)?);
    Ok(measurement)
}

const BYTES: u64 = 4096;

/// Handles that go when this does.
struct Aliased<'g> {
    gpu: &'g Gpu,
    memory: vk::DeviceMemory,
    buffers: [vk::Buffer; 2],
}

impl Drop for Aliased<'_> {
    fn drop(&mut self) {
        // SAFETY: all that was recorded with them was waited for; null is ignored.
        unsafe {
            for buffer in self.buffers {
                self.gpu.device().destroy_buffer(buffer, None);
            }
            self.gpu.device().free_memory(self.memory, None);
        }
    }
}

fn aliased(stand: &mut Stand) -> Result<Measurement, Stop> {
    let device = stand.device()?;
    let gpu = Arc::clone(device.gpu());
    let mut made = Aliased {
        gpu: &gpu,
        memory: vk::DeviceMemory::null(),
        buffers: [vk::Buffer::null(); 2],
    };
    let usage = vk::BufferUsageFlags::TRANSFER_DST | vk::BufferUsageFlags::TRANSFER_SRC;
    let info = vk::BufferCreateInfo::default().size(BYTES).usage(usage);
    let raw = gpu.device();
    // SAFETY: the device is valid; memory is of a type that both buffers take, and as large as they want it.
    unsafe {
        for buffer in &mut made.buffers {
            *buffer = raw
                .create_buffer(&info, None)
                .map_err(refused("make a buffer"))?;
        }
        let wants = made
            .buffers
            .map(|buffer| raw.get_buffer_memory_requirements(buffer));
        let types = wants[0].memory_type_bits & wants[1].memory_type_bits;
        let info = vk::MemoryAllocateInfo::default()
            .allocation_size(wants[0].size.max(wants[1].size))
            .memory_type_index(types.trailing_zeros());
        made.memory = raw
            .allocate_memory(&info, None)
            .map_err(refused("allocate"))?;
        for buffer in made.buffers {
            raw.bind_buffer_memory(buffer, made.memory, 0)
                .map_err(refused("bind memory"))?;
        }
    }
    let to = vk::BufferUsageFlags::TRANSFER_DST;
    let back = Buffer::new(&gpu, BYTES, to, Memory::Readback, "readback")?;
    let [first, second] = made.buffers;
    let half = BYTES / 2;
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
    let found: Vec<u32> = super::kit::read(&back)?;
    let mut measurement = Measurement::new(Bound::new("aliased", ALIASED), 1000);
    for (i, found) in found.into_iter().enumerate() {
        let wanted: u32 = if i < 512 { 0x1234_5678 } else { 0x9abc_def0 };
        measurement.take(|| format!("word {i}"), wanted.into(), found.into(), 0.0);
    }
    Ok(measurement)
}

/// # Safety
/// `cmd` is recording on the device.
unsafe fn barrier(device: &ash::Device, cmd: vk::CommandBuffer) {
    let (stage, access, _) = Use::TransferWrite.state();
    let memory = [vk::MemoryBarrier2::default()
        .src_stage_mask(stage)
        .src_access_mask(access)
        .dst_stage_mask(stage)
        .dst_access_mask(access | vk::AccessFlags2::TRANSFER_READ)];
    let info = vk::DependencyInfo::default().memory_barriers(&memory);
    // SAFETY: the caller's promise.
    unsafe { device.cmd_pipeline_barrier2(cmd, &info) };
}
