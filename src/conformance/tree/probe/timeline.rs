//! Timeline semaphores: counters, waits, large numbers.

use super::raw::refused;
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::test_bed::TestBed;
use crate::gpu::owned::Own;
use crate::gpu::{Feature, Gpu, Headless, Item};
use ash::vk;
use std::sync::Arc;

const LARGE: &str = "Counters have 64 bits, and maxTimelineSemaphoreValueDifference is 2^31 - 1 or more (Vulkan specification, required \
limits): steps of that size, across the middle of what 64 bits hold and to their end.";
const TIMELINE: &str = "The Vulkan specification says what the counter of a timeline semaphore is after each signal, and that a wait \
ends when its value is reached and not before.";
/// Small steps, and large ones.
pub fn cases() -> Vec<Case> {
    let need = Item::Feature(Feature::TimelineSemaphore);
    vec![
        Case::new("probe.timeline_semaphore", timeline).needing(need),
        Case::new("probe.timeline_semaphore.large_values", large).needing(need),
    ]
}

/// A timeline that starts at `value`.
fn made(gpu: &Arc<Gpu>, value: u64) -> Result<Own<vk::Semaphore>, Stop> {
    let mut kind = vk::SemaphoreTypeCreateInfo::default()
        .semaphore_type(vk::SemaphoreType::TIMELINE)
        .initial_value(value);
    let info = vk::SemaphoreCreateInfo::default().push_next(&mut kind);
    // SAFETY: the feature is a need of these cases.
    let semaphore = unsafe { gpu.device().create_semaphore(&info, None) };
    Ok(Own::new(
        gpu,
        semaphore.map_err(refused("make a semaphore"))?,
    ))
}

fn timeline(bed: &mut TestBed) -> Result<Measurement, Stop> {
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let semaphore = made(&gpu, 5)?;
    let asked = ask_timeline(device, semaphore.get());
    // SAFETY: nobody else has the queue; what was submitted goes before the semaphore does.
    let _ = device.on_queue(|queue| unsafe { gpu.device().queue_wait_idle(queue) });
    asked
}

/// Counters around half of what 64 bits hold, in the largest steps that every device takes.
fn large(bed: &mut TestBed) -> Result<Measurement, Stop> {
    const STEP: u64 = (1 << 31) - 1;
    let gpu = Arc::clone(bed.device()?.gpu());
    let mut measurement = Measurement::new(Bound::new("large-timeline", LARGE), 9);
    // The validation layer (1.3.239) takes a signal beyond 2^63 as pending for ever: each counter has but one.
    for (start, steps) in [((1 << 63) - 2 * STEP + 5, 2), (u64::MAX - STEP - 1, 1)] {
        climb(&gpu, &mut measurement, start, steps, STEP)?;
    }
    Ok(measurement)
}

/// So many steps of a counter.
fn climb(
    gpu: &Arc<Gpu>,
    measurement: &mut Measurement,
    start: u64,
    steps: u64,
    length: u64,
) -> Result<(), Stop> {
    let semaphore = made(gpu, start)?;
    let device = gpu.device();
    let semaphores = [semaphore.get()];
    for step in 1..=steps {
        let value = start + step * length;
        let signal = vk::SemaphoreSignalInfo::default()
            .semaphore(semaphore.get())
            .value(value);
        let (here, next) = ([value], [value + 1]);
        let wait = |values| {
            vk::SemaphoreWaitInfo::default()
                .semaphores(&semaphores)
                .values(values)
        };
        // SAFETY: a timeline of this device; values rise, by no more than every device allows.
        let (counter, reached, beyond) = unsafe {
            device
                .signal_semaphore(&signal)
                .map_err(refused("signal a semaphore"))?;
            let counter = device.get_semaphore_counter_value(semaphore.get());
            (
                counter.map_err(refused("read a counter"))?,
                device.wait_semaphores(&wait(&here), 0),
                device.wait_semaphores(&wait(&next), 0),
            )
        };
        measurement.hold(|| format!("the counter is {value}"), counter == value);
        measurement.hold(|| format!("{value} is reached"), reached == Ok(()));
        let is_open = beyond == Err(vk::Result::TIMEOUT);
        measurement.hold(|| format!("one more than {value} is not"), is_open);
    }
    Ok(())
}

fn ask_timeline(headless: &Headless, semaphore: vk::Semaphore) -> Result<Measurement, Stop> {
    const SECONDS: u64 = 10_000_000_000;
    let device = headless.gpu().device();
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
    let submitted = headless.on_queue(|queue| {
        // SAFETY: nobody else has the queue; synchronization2 is required.
        unsafe { device.queue_submit2(queue, &submit, vk::Fence::null()) }
    });
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
