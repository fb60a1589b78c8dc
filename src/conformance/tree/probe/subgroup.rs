//! Subgroups: how large they are, who is in one, and what its operations give.

use super::kit;
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::need::Want;
use crate::conformance::stand::Stand;
use crate::gpu::{Gpu, Resource};
use ash::vk::{self, SubgroupFeatureFlags as Flags};
use std::collections::BTreeMap;
use std::sync::Arc;

const PLACES: &str = "Vulkan specification, subgroups: SubgroupSize is the device's subgroupSize where a stage does not ask for a \
varying one; it is a power of two from 1 to 128, and minSubgroupSize and maxSubgroupSize bound it. Invocations of a workgroup lie in one \
subgroup each, with a number below NumSubgroups and a place of their own below SubgroupSize.";
const TOGETHER: &str = "SPIR-V specification, group and subgroup instructions: whole numbers, over the invocations that say they are in \
the same subgroup: there is one right answer. What reads an invocation that is not there is left out.";

type Together = fn(&Member, &[Member]) -> [Option<u32>; 4];

/// One an operation.
pub fn cases() -> Vec<Case> {
    let all: [(&'static str, Flags, Together); 6] = [
        ("basic", Flags::BASIC, basic),
        ("vote", Flags::VOTE, vote),
        ("arithmetic", Flags::ARITHMETIC, arithmetic),
        ("ballot", Flags::BALLOT, ballot),
        ("broadcast", Flags::BALLOT, broadcast),
        ("shuffle", Flags::SHUFFLE, shuffle),
    ];
    let case = |(word, flags, together): (&'static str, Flags, Together)| {
        let name = format!("probe.subgroup.{word}");
        let case = Case::new(name, move |stand| measure(stand, word, together));
        case.wanting(Want::Subgroups(Flags::BASIC | flags))
    };
    let mut cases: Vec<Case> = all.map(case).into();
    cases.push(
        Case::new("probe.subgroup.size", |stand| {
            let told = ask(stand, "basic")?;
            let gpu = stand.device()?.gpu();
            Ok(sizes(&told, gpu))
        })
        .wanting(Want::Subgroups(Flags::BASIC)),
    );
    cases
}

const GROUP: usize = 128;

/// One invocation.
#[derive(Clone, Copy, Debug)]
struct Member {
    number: u32,
    size: u32,
    lane: u32,
    subgroup: u32,
    subgroups: u32,
    found: [u32; 4],
}

/// All invocations, in their order.
fn ask(stand: &mut Stand, word: &str) -> Result<Vec<Member>, Stop> {
    const COUNT: usize = 32 * GROUP;
    let mut random = stand.random("subgroups");
    // Whole subgroups of large numbers too, so that votes differ.
    let numbers: Vec<u32> = (0..COUNT)
        .map(|i| random.below(16) | if i % 256 < 96 { 8 } else { 0 })
        .collect();
    let device = stand.device()?;
    let gpu = Arc::clone(device.gpu());
    let given = kit::buffer(&gpu, &numbers, "numbers")?;
    let found = kit::zeros::<[u32; 4]>(&gpu, 2 * COUNT, "found")?;
    let resources = [
        ("numbers", Resource::Storage(&given)),
        ("found", Resource::Storage(&found)),
    ];
    let shader = format!("probe/subgroup.{word}");
    kit::compute(device, &shader, &resources, [(COUNT / GROUP) as u32, 1, 1])?;
    let found: Vec<[u32; 4]> = kit::read(&found)?;
    let pairs = found.as_chunks::<2>().0.iter();
    let member =
        |(&number, &[[size, lane, subgroup, subgroups], found]): (&u32, &[[u32; 4]; 2])| Member {
            number,
            size,
            lane,
            subgroup,
            subgroups,
            found,
        };
    Ok(numbers.iter().zip(pairs).map(member).collect())
}

fn sizes(told: &[Member], gpu: &Gpu) -> Measurement {
    let mut properties11 = vk::PhysicalDeviceVulkan11Properties::default();
    let mut properties13 = vk::PhysicalDeviceVulkan13Properties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default()
        .push_next(&mut properties11)
        .push_next(&mut properties13);
    // SAFETY: the physical device belongs to the instance; both live as long as `gpu`.
    unsafe {
        let instance = gpu.instance();
        instance.get_physical_device_properties2(gpu.physical_device(), &mut properties);
    }
    let size = properties11.subgroup_size;
    let [least, most] = [
        properties13.min_subgroup_size,
        properties13.max_subgroup_size,
    ];
    let bound = Bound::new("subgroup-places", PLACES)
        .with("subgroupSize", size.into())
        .with("minSubgroupSize", least.into())
        .with("maxSubgroupSize", most.into());
    let mut measurement = Measurement::new(bound, told.len());
    for (word, size) in [("subgroupSize", size), ("least", least), ("most", most)] {
        let is_one = size.is_power_of_two() && size <= 128;
        measurement.hold(|| format!("{word} is a power of two up to 128"), is_one);
    }
    let is_between = least <= size && size <= most;
    measurement.hold(|| "subgroupSize is bounded".into(), is_between);
    for (i, member) in told.iter().enumerate() {
        let at = || format!("the size that invocation {i} sees");
        measurement.take(at, size.into(), member.size.into(), 0.0);
    }
    measurement
}

fn measure(stand: &mut Stand, word: &str, together: Together) -> Result<Measurement, Stop> {
    let told = ask(stand, word)?;
    let bound = Bound::new("subgroups", format!("{PLACES} {TOGETHER}"));
    let mut measurement = Measurement::new(bound, told.len());
    for (group, members) in told.chunks(GROUP).enumerate() {
        let mut subgroups: BTreeMap<u32, Vec<Member>> = BTreeMap::new();
        for member in members {
            subgroups.entry(member.subgroup).or_default().push(*member);
        }
        let count = subgroups.len() as u32;
        for (number, mut all) in subgroups {
            all.sort_by_key(|member| member.lane);
            let at = |what: &str| format!("{what} of subgroup {number} of workgroup {group}");
            let is_known = number < all[0].subgroups && count == all[0].subgroups;
            measurement.hold(|| at("the number"), is_known);
            let is_apart = all.windows(2).all(|two| two[0].lane < two[1].lane);
            let is_below = all.iter().all(|member| member.lane < member.size);
            measurement.hold(|| at("places"), is_apart && is_below);
            for member in &all {
                for (i, wanted) in together(member, &all).into_iter().enumerate() {
                    match wanted {
                        Some(wanted) => {
                            let at = || at(&format!("result {i} at place {}", member.lane));
                            let found = member.found[i].into();
                            measurement.take(at, wanted.into(), found, 0.0);
                        }
                        None => measurement.leave_out(1),
                    }
                }
            }
        }
    }
    Ok(measurement)
}

fn basic(member: &Member, _: &[Member]) -> [Option<u32>; 4] {
    [member.number, member.lane, 0, 0].map(Some)
}

fn vote(_: &Member, all: &[Member]) -> [Option<u32>; 4] {
    let votes = [
        all.iter().all(|m| m.number >= 8),
        all.iter().any(|m| m.number >= 8),
        all.iter().all(|m| m.number >= 1),
        all.iter().any(|m| m.number < 1),
    ];
    votes.map(|vote| Some(u32::from(vote)))
}

fn arithmetic(member: &Member, all: &[Member]) -> [Option<u32>; 4] {
    let before = all.iter().filter(|m| m.lane < member.lane);
    [
        Some(all.iter().map(|m| m.number).sum()),
        Some(before.map(|m| m.number).sum()),
        all.iter().map(|m| m.number).max(),
        Some(all.iter().fold(0, |bits, m| bits ^ m.number)),
    ]
}

fn ballot(_: &Member, all: &[Member]) -> [Option<u32>; 4] {
    let mut bits = [0u32; 4];
    for member in all.iter().filter(|m| m.number % 2 == 1 && m.lane < 128) {
        bits[member.lane as usize / 32] |= 1 << (member.lane % 32);
    }
    bits.map(Some)
}

/// The number at a place.
fn lane(all: &[Member], lane: u32) -> Option<u32> {
    let there = all.iter().find(|member| member.lane == lane);
    there.map(|member| member.number)
}

fn broadcast(_: &Member, all: &[Member]) -> [Option<u32>; 4] {
    [Some(all[0].number), lane(all, 2), Some(0), Some(0)]
}

fn shuffle(member: &Member, all: &[Member]) -> [Option<u32>; 4] {
    [
        lane(all, member.lane ^ 3),
        lane(all, member.lane ^ 1),
        Some(0),
        Some(0),
    ]
}
