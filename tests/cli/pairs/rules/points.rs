//! Scattered points and spheres.

use super::{Rule, no_meaning, not_built, of};

/// In their order.
pub const RULES: &[Rule] = &[
    of(
        &[
            "scattered points",
            "scattered points as spheres",
            "scattered points as a field",
        ],
        no_meaning(
            "is for volumes, and",
            "scattered points have neither voxels nor a grid",
        ),
    ),
    not_built(
        "casting scattered points by rays is for the technique raycast",
        "each fragment of 443 slices, and each flight of a path, would go through some 40 points around it",
    ),
    not_built(
        "casting scattered points by rays is for the modes composite, mip, minip, average and xray",
        "3 shader variants more; surfaces ask for 6 values more at each hit, of some 40 points each",
    ),
    no_meaning(
        "casting scattered points by rays is for the kernel of points",
        "a kernel makes the values, and there are no voxels to filter",
    ),
    no_meaning(
        "casting scattered points by rays is for empty cells of points",
        "an octree is of voxels; points lie in cells, of which rays skip the empty ones",
    ),
    not_built(
        "casting scattered points by rays is for samples that are points",
        "values at both ends of a slab, which are those of its neighbours too: a table in place of a look",
    ),
    not_built(
        "casting scattered points by rays is for what lies behind cuts",
        "one sample more a ray",
    ),
    not_built(
        "casting scattered points by rays is for matter that is not lit",
        "the gradient of the kernel: 6 sums a sample in place of 2, and a light volume of some 40 points a cell",
    ),
    not_built(
        "casting scattered points by rays is for functions of the value alone",
        "the gradient of the kernel: 6 sums a sample in place of 2",
    ),
    no_meaning(
        "spheres are no volume",
        "spheres are surfaces, lit already: a ray takes no samples of them",
    ),
];
