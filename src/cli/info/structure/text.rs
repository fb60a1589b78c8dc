//! The same for a person.

use super::{LeafReport, LevelReport, OctreeReport, RunsReport, SetReport, StructureReport};
use crate::cli::{
    info::text::Lines,
    readable::{bytes, grouped},
};

/// Letters of addresses in a line.
const LINE: usize = 76;

/// A group of lines for each set.
pub fn say(report: &StructureReport, lines: &mut Lines) {
    lines.group();
    match &report.preclassified {
        Some(set) => {
            lines.say(
                "full",
                full(set, "whose own value has opacity (--preclassified)"),
            );
            say_set(set, lines);
        }
        None => lines.say(
            "full",
            "no voxel by its own value: the function looks at gradients too",
        ),
    }
    lines.group();
    let filter = &report.filter;
    let set = &report.postclassified;
    let why = format!("in which --filter {filter} can make a value with opacity");
    lines.say("full", full(set, &why));
    say_set(set, lines);
}

fn full(set: &SetReport, why: &str) -> String {
    let percent = 100.0 * set.share;
    format!("{} voxels, {percent:.1} %, {why}", grouped(set.full))
}

fn say_set(set: &SetReport, lines: &mut Lines) {
    for (name, runs) in ["runs", "", ""].into_iter().zip(&set.runs) {
        lines.say(name, along(runs));
    }
    say_octree(&set.octree, lines);
}

fn along(report: &RunsReport) -> String {
    let mean = match report.mean_length {
        Some(mean) => format!(" of {mean:.1} voxels in the mean"),
        None => String::new(),
    };
    format!(
        "along {}: {}{mean}, {}; as masks {}",
        report.axis,
        grouped(report.runs as u64),
        bytes(report.bytes),
        bytes(report.mask_bytes)
    )
}

fn say_octree(octree: &OctreeReport, lines: &mut Lines) {
    let nodes = match octree.nodes {
        1 => "1 node".to_owned(),
        nodes => format!("{} nodes", grouped(nodes)),
    };
    let mixed = grouped(octree.mixed as u64);
    let (side, bytes) = (octree.side, bytes(octree.bytes));
    let line = format!("{nodes} of a cube of {side} voxels a side, {mixed} mixed, {bytes}");
    lines.say("octree", line);
    for level in &octree.levels {
        let LevelReport {
            side,
            empty,
            full,
            mixed,
        } = level;
        let [empty, full, mixed] = [empty, full, mixed].map(|&count| grouped(count));
        let line = format!("side {side:>5}  {empty:>11} empty  {full:>11} full  {mixed:>11} mixed");
        lines.say("", line);
    }
    if let Some(LeafReport { full, empty }) = &octree.leaves {
        say_leaves("full leaves", full, lines);
        say_leaves("empty leaves", empty, lines);
    }
}

/// Addresses in lines.
fn say_leaves(name: &str, addresses: &[String], lines: &mut Lines) {
    let mut rest = addresses;
    let mut name = name;
    while !rest.is_empty() {
        let mut letters = 0;
        let fitting = rest.iter().take_while(|address| {
            letters += address.len() + 1;
            letters <= LINE
        });
        let (line, others) = rest.split_at(fitting.count().max(1));
        lines.say(name, said(line));
        (name, rest) = ("", others);
    }
}

fn said(addresses: &[String]) -> String {
    match addresses {
        [root] if root.is_empty() => "the root".to_owned(),
        addresses => addresses.join(" "),
    }
}
