//! Injected faults of what rays leave out by single voxels: the runs of a set of voxels and its octree.

use super::Fault::{self, Shader};

const RUNS: &str = "relation.skipped_by_runs.raycast.ray.composite.perspective";
const OCTREE: &str = "relation.skipped_by_octree.raycast.ray.composite.perspective";
/// The same of rays from the beginning of rows to their ends.
const RUNS_UP: &str = "relation.skipped_by_runs.raycast.ray.composite.orthographic";
const OCTREE_UP: &str = "relation.skipped_by_octree.raycast.ray.composite.orthographic";

/// What is wrong, how, and the case that must see it.
pub const VOXEL_FAULTS: &[(&str, Fault, &str)] = &[
    (
        "the last voxel of a word of 32 is always empty",
        Shader(
            "lib/skipped_runs.wgsl",
            "(voxel.y + dims.y * voxel.z))];",
            "(voxel.y + dims.y * voxel.z))] & 0x7fffffffu;",
        ),
        RUNS,
    ),
    (
        "the mask of the next word is that of a voxel's own",
        Shader(
            "lib/skipped_runs.wgsl",
            "full_voxels.d[2u * (word + words_of_row",
            "full_voxels.d[2u * (word + 1u + words_of_row",
        ),
        RUNS,
    ),
    (
        "the number of full voxels before a word is its mask",
        Shader(
            "lib/skipped_runs.wgsl",
            "full_voxels.d[2u * (word + words_of_row * (voxel.y + dims.y * voxel.z))]",
            "full_voxels.d[2u * (word + words_of_row * (voxel.y + dims.y * voxel.z)) + 1u]",
        ),
        RUNS,
    ),
    (
        "runs go on over the end of a row",
        Shader(
            "lib/skipped_runs.wgsl",
            "(dims.x + WORD_VOXELS - 1u) / WORD_VOXELS",
            "dims.x / WORD_VOXELS",
        ),
        RUNS,
    ),
    (
        "what is before a voxel in its word is as empty as it is",
        Shader(
            "lib/skipped_runs.wgsl",
            "WORD_VOXELS * word + (WORD_VOXELS - countLeadingZeros(before))",
            "WORD_VOXELS * word",
        ),
        RUNS,
    ),
    (
        "what is behind a voxel in its word is as empty as it is",
        Shader(
            "lib/skipped_runs.wgsl",
            "min(bit + countTrailingZeros(full >> bit), WORD_VOXELS)",
            "WORD_VOXELS",
        ),
        RUNS_UP,
    ),
    (
        "children of an octree are in the order of z first",
        Shader(
            "lib/skipped_octree.wgsl",
            "upper.x + 2u * upper.y + 4u * upper.z",
            "upper.z + 2u * upper.y + 4u * upper.x",
        ),
        OCTREE,
    ),
    (
        "a mixed child of an octree counts itself among those before it",
        Shader(
            "lib/skipped_octree.wgsl",
            "((1u << child) - 1u)",
            "((2u << child) - 1u)",
        ),
        OCTREE,
    ),
    (
        "mixed children of an octree are empty",
        Shader(
            "lib/skipped_octree.wgsl",
            "(bits & 1u) + ((bits >> 7u) & 2u)",
            "(bits & 1u)",
        ),
        OCTREE,
    ),
    (
        "full children of an octree are empty",
        Shader(
            "lib/skipped_octree.wgsl",
            "(bits & 1u) + ((bits >> 7u) & 2u)",
            "(bits >> 7u) & 2u",
        ),
        OCTREE,
    ),
    (
        "cubes of an octree are twice as large",
        Shader(
            "lib/skipped_octree.wgsl",
            "first + (1u << level)",
            "first + (2u << level)",
        ),
        OCTREE_UP,
    ),
    (
        "samples lie in the next voxel",
        Shader(
            "lib/full_voxels.wgsl",
            "(line.at + f32(k) * line.step);",
            "(line.at + f32(k) * line.step) + 1.0;",
        ),
        OCTREE,
    ),
];
