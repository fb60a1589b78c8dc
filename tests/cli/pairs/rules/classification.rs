//! Pre-integration and pre-classification.

use super::{Rule, no_meaning, not_built};

/// In their order.
pub const RULES: &[Rule] = &[
    // Pre-integration: tables over both ends of a slab.
    not_built(
        "pre-integrated classification is for one volume of numbers",
        "a function of two numbers has no integral that both ends of a slab give: a table over them has 256^4 entries, 32 GiB",
    ),
    not_built(
        "slabs are integrated over one number",
        "a product of two functions has no integral that both ends of a slab give: a table over them has 256^4 entries, 32 GiB",
    ),
    not_built(
        "pre-integrated classification is for functions of the value alone",
        "a function of value and gradient has no integral that both ends of a slab give: a table over them has 256^4 entries, 32 GiB",
    ),
    not_built(
        "pre-integrated classification is for nearest and linear filters",
        "slabs of a cubic filter: 64 fetches at each end in place of 8, and 62 shader variants more",
    ),
    no_meaning(
        "empty space by an octree or by runs is for samples that are points",
        "a slab reaches into the next voxel, which the octree may have left out",
    ),
    // Pre-classification: colours at voxels.
    no_meaning(
        "--smooth and --jitter sample values",
        "voxels that are classified have colours, which neither are tabulated between slices nor show bands that jitter would hide",
    ),
    no_meaning(
        "widgets and gradient opacity need a gradient",
        "voxels are classified by their value alone",
    ),
    not_built(
        "--preclassified is for one number a voxel",
        "as many volumes of colours as there are volumes: 4 numbers a voxel and volume in place of 1",
    ),
];
