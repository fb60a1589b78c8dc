//! `--structure`: which voxels are full under a transfer function, and what run-length encoding and an octree make of them.

mod text;

pub use text::say;

use crate::{
    cli::{
        Error,
        flags::{Classification, ClassificationFlags, InputFlags, context},
        load,
        output::say_aside,
    },
    technique::{
        Filter, Mode, Settings,
        full_voxels::{full_after_filtering, full_before_filtering},
    },
    volume::{LevelCount, Limits, Octree, Runs, Volume, VoxelSet},
};
use serde::Serialize;

/// Of so many leaves the addresses are said.
const MAX_LEAVES: u64 = 64;

/// The JSON, key by key.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StructureReport {
    /// The filter whose values are looked at: that of a picture without a flag.
    filter: String,
    /// Full before filtering; `null` where the function looks at gradients.
    preclassified: Option<SetReport>,
    /// Full after filtering.
    postclassified: SetReport,
}

/// A set of full voxels.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct SetReport {
    full: u64,
    /// Of all voxels.
    share: f64,
    /// Along x, y, z.
    runs: [RunsReport; 3],
    octree: OctreeReport,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct RunsReport {
    axis: &'static str,
    runs: usize,
    /// Voxels; `null` without a run.
    mean_length: Option<f64>,
    /// Of rows and runs.
    bytes: u64,
    /// Of masks and ranks.
    mask_bytes: u64,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct OctreeReport {
    side: u64,
    nodes: u64,
    mixed: usize,
    bytes: u64,
    /// From the root down.
    levels: Vec<LevelReport>,
    /// Addresses; `null` where there are many.
    leaves: Option<LeafReport>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct LevelReport {
    side: u64,
    empty: u64,
    full: u64,
    mixed: u64,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct LeafReport {
    full: Vec<String>,
    empty: Vec<String>,
}

/// Reads the one volume that the words pick, and looks at it.
pub fn read(
    input: &InputFlags,
    classification: &ClassificationFlags,
    limits: &Limits,
) -> Result<StructureReport, Error> {
    let source = load::open(input, limits)?;
    let header = source.header();
    let (pick, note) = input.pick(header)?;
    if let Some(note) = &note {
        say_aside(note);
    }
    let volume = Volume::read(source.as_ref(), pick, header.whole(), limits)?;
    let flags = ClassificationFlags {
        context: Some(context(header)),
        ..classification.clone()
    };
    let found = flags.classification(&volume, Mode::Composite)?;
    let is_of_labels = header.is_labels || flags.found_labels(&found);
    let Classification::Function(function) = found else {
        unreachable!("only integrals have no function yet")
    };
    // As a picture has it by itself.
    let filter = match is_of_labels {
        true => Filter::Nearest,
        false => Filter::Linear,
    };
    let settings = Settings {
        filter,
        ..Settings::default()
    };
    let before = (!function.uses_gradient()).then(|| full_before_filtering(&volume, &function));
    let after = full_after_filtering(&volume, &function, settings.halo());
    Ok(StructureReport {
        filter: filter.to_string(),
        preclassified: before.as_ref().map(SetReport::new),
        postclassified: SetReport::new(&after),
    })
}

impl SetReport {
    fn new(set: &VoxelSet) -> Self {
        let full = set.full_count();
        Self {
            full,
            share: full as f64 / set.voxel_count().max(1) as f64,
            runs: [0, 1, 2].map(|axis| RunsReport::new(&Runs::new(set, axis))),
            octree: OctreeReport::new(&Octree::new(set)),
        }
    }
}

impl RunsReport {
    fn new(runs: &Runs) -> Self {
        let count = runs.run_count();
        let mean = runs.full_count() as f64 / count as f64;
        Self {
            axis: ["x", "y", "z"][runs.axis()],
            runs: count,
            mean_length: (count > 0).then_some(mean),
            bytes: runs.bytes(),
            mask_bytes: runs.bits().bytes(),
        }
    }
}

impl OctreeReport {
    fn new(octree: &Octree) -> Self {
        let of_level = |level: LevelCount| LevelReport {
            side: level.side,
            empty: level.empty,
            full: level.full,
            mixed: level.mixed,
        };
        let is_told = octree.leaf_count() <= MAX_LEAVES;
        Self {
            side: octree.side(),
            nodes: octree.node_count(),
            mixed: octree.nodes().len(),
            bytes: octree.bytes(),
            levels: octree.levels().into_iter().map(of_level).collect(),
            leaves: is_told.then(|| LeafReport::new(octree)),
        }
    }
}

impl LeafReport {
    fn new(octree: &Octree) -> Self {
        let of = |is_full: bool| {
            let leaves = octree.leaves().filter(|leaf| leaf.is_full == is_full);
            leaves.map(|leaf| leaf.address.to_string()).collect()
        };
        Self {
            full: of(true),
            empty: of(false),
        }
    }
}
