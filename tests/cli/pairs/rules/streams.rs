//! Volumes brick by brick, the CPU references, and lines.

use super::{Rule, no_meaning, not_built, of};

/// In their order.
pub const RULES: &[Rule] = &[
    // Brick by brick.
    of(
        &[
            "scattered points",
            "scattered points as spheres",
            "scattered points as a field",
        ],
        no_meaning("--stream is not for", "scattered points have no bricks"),
    ),
    not_built(
        "--stream is not for --technique",
        "slices go through all bricks: each brick would be read again for each of the 443 slices of 256^3 voxels that cut it",
    ),
    not_built(
        "--stream is not for --with, --labels",
        "bricks of all volumes at once: n times the memory for n volumes, and grids of their own cut across bricks",
    ),
    not_built(
        "--stream is not for --ambient-occlusion and --shadows",
        "light goes through the whole volume first: the file is read twice",
    ),
    not_built(
        "--stream is not for --filter",
        "the prefilter of a spline goes along whole rows: the file is read and written once for each of three axes",
    ),
    not_built(
        "--stream is not for --denoise",
        "bricks would be read with neighbours as wide as the filter: (64 + 2 r)^3 voxels for 64^3, 1.3 times for r = 3",
    ),
    not_built(
        "--stream is not for several numbers a voxel",
        "bricks of n numbers: n times the memory and n textures a brick",
    ),
    not_built(
        "a volume that is drawn brick by brick has no empty space by an octree",
        "an octree for each brick, made on the host each time a brick is read: 1.1 bits a voxel",
    ),
    // The CPU reference.
    not_built(
        "--stream is not for --device reference",
        "the CPU reference follows one pixel after another through the whole volume: each brick would be read once a row of tiles",
    ),
    // Lines.
    of(
        &["lines of the wind"],
        no_meaning(
            "lines follow the linear field",
            "lines follow the linear field: a volume by another filter beside them would be another field",
        ),
    ),
];
