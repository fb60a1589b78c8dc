//! Compute: shared memory and barriers, atomics, large dispatches, chains of dispatches. Whole numbers, all exact.

use super::kit;
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::test_bed::TestBed;
use crate::gpu::{Resource, Use, buffer_barrier};
use std::sync::Arc;

const EXACT: &str = "Whole numbers of 32 bits: there is one right answer.";

/// One question a part.
pub fn cases() -> Vec<Case> {
    let mut cases = vec![
        Case::new("probe.compute.shared_memory", shared_memory),
        Case::new("probe.compute.atomics", atomics),
        Case::new("probe.compute.chain", chain),
    ];
    for (axis, word) in ["x", "y", "z"].into_iter().enumerate() {
        let name = format!("probe.compute.dispatch.most_along_{word}");
        cases.push(Case::new(name, move |bed| dispatch(bed, axis)));
    }
    cases
}

fn shared_memory(bed: &mut TestBed) -> Result<Measurement, Stop> {
    const GROUP: usize = 128;
    const COUNT: usize = 64 * GROUP;
    let mut random = bed.random("shared_memory");
    let numbers: Vec<u32> = (0..COUNT).map(|_| random.bits() as u32).collect();
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let given = kit::buffer(&gpu, &numbers, "numbers")?;
    let sums = kit::zeros::<u32>(&gpu, COUNT, "sums")?;
    let resources = [
        ("numbers", Resource::Storage(&given)),
        ("sums", Resource::Storage(&sums)),
    ];
    kit::compute(device, "probe/shared_memory", &resources, [64, 1, 1])?;
    let found: Vec<u32> = kit::read(&sums)?;
    let mut measurement = Measurement::new(Bound::new("exact", EXACT), COUNT);
    let mut sum = 0u32;
    for (i, (&number, found)) in numbers.iter().zip(found).enumerate() {
        sum = if i % GROUP == 0 {
            number
        } else {
            sum.wrapping_add(number)
        };
        measurement.take(|| format!("sum {i}"), sum.into(), found.into(), 0.0);
    }
    Ok(measurement)
}

fn atomics(bed: &mut TestBed) -> Result<Measurement, Stop> {
    const COUNT: usize = 1 << 16;
    let mut random = bed.random("atomics");
    let numbers: Vec<u32> = (0..COUNT)
        .map(|_| 1 + (random.bits() as u32 >> 1))
        .collect();
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let given = kit::buffer(&gpu, &numbers, "numbers")?;
    let tickets = kit::zeros::<u32>(&gpu, COUNT, "tickets")?;
    let all = kit::zeros::<u32>(&gpu, 6, "together")?;
    // Next, largest, smallest, set, flipped, exchanged.
    let start = [0u32, 0, u32::MAX, 0, 0, 7];
    all.write(0, bytemuck::cast_slice(&start))?;
    let resources = [
        ("numbers", Resource::Storage(&given)),
        ("tickets", Resource::Storage(&tickets)),
        ("together", Resource::Storage(&all)),
    ];
    kit::compute(
        device,
        "probe/atomics",
        &resources,
        [COUNT as u32 / 64, 1, 1],
    )?;
    let mut tickets: Vec<u32> = kit::read(&tickets)?;
    let found: Vec<u32> = kit::read(&all)?;
    let mut measurement = Measurement::new(Bound::new("exact", EXACT), COUNT);
    tickets.sort_unstable();
    for (i, ticket) in tickets.into_iter().enumerate() {
        measurement.take(|| format!("ticket {i}"), i as f64, ticket.into(), 0.0);
    }
    let wanted = [
        COUNT as u32,
        numbers.iter().copied().max().unwrap_or(0),
        numbers.iter().copied().min().unwrap_or(0),
        numbers.iter().fold(0, |set, n| set | n),
        numbers.iter().fold(0, |flipped, n| flipped ^ n),
        108,
    ];
    let names = ["add", "max", "min", "or", "xor", "compare and exchange"];
    for ((name, wanted), found) in names.iter().zip(wanted).zip(found) {
        measurement.take(|| (*name).to_owned(), wanted.into(), found.into(), 0.0);
    }
    Ok(measurement)
}

/// As many workgroups along one axis as the device says, up to the 65 535 that every device has.
fn dispatch(bed: &mut TestBed, axis: usize) -> Result<Measurement, Stop> {
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let most = gpu.limits().max_workgroup_count[axis].min(65_535);
    let mut groups = [1; 3];
    groups[axis] = most;
    let found = kit::zeros::<u32>(&gpu, most as usize, "found")?;
    kit::compute(
        device,
        "probe/dispatch",
        &[("found", Resource::Storage(&found))],
        groups,
    )?;
    let found: Vec<u32> = kit::read(&found)?;
    let bound = Bound::new("exact", EXACT).with("workgroups", most.into());
    let mut measurement = Measurement::new(bound, 65_535);
    for (i, found) in found.into_iter().enumerate() {
        measurement.take(
            || format!("workgroup {i}"),
            i as f64 + 1.0,
            found.into(),
            0.0,
        );
    }
    Ok(measurement)
}

/// Dispatches that read what the one before wrote, with a barrier between each two.
fn chain(bed: &mut TestBed) -> Result<Measurement, Stop> {
    const COUNT: usize = 1 << 14;
    const STEPS: usize = 64;
    let mut random = bed.random("chain");
    let numbers: Vec<u32> = (0..COUNT).map(|_| random.below(1 << 20)).collect();
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let both = [
        kit::zeros::<u32>(&gpu, COUNT, "a")?,
        kit::zeros::<u32>(&gpu, COUNT, "b")?,
    ];
    both[0].write(0, bytemuck::cast_slice(&numbers))?;
    let step = |i: usize| {
        vec![
            ("before", Resource::Storage(&both[i % 2])),
            ("after", Resource::Storage(&both[(i + 1) % 2])),
        ]
    };
    let steps: Vec<_> = (0..STEPS).map(step).collect();
    let written = [&both[0], &both[1]];
    kit::chain(
        device,
        "probe/steps",
        &steps,
        &written,
        [COUNT as u32 / 64, 1, 1],
    )?;
    device.run(|cmd| {
        // SAFETY: recorded outside rendering; `run` waits.
        unsafe { buffer_barrier(&gpu, cmd, &both[0], Use::ComputeWrite, Use::HostRead) };
        Ok(())
    })?;
    let found: Vec<u32> = kit::read(&both[STEPS % 2])?;
    let mut measurement = Measurement::new(Bound::new("exact", EXACT), COUNT);
    for (i, found) in found.into_iter().enumerate() {
        let wanted = numbers[(i + COUNT - STEPS) % COUNT] + STEPS as u32;
        measurement.take(|| format!("number {i}"), wanted.into(), found.into(), 0.0);
    }
    Ok(measurement)
}
