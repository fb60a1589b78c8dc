//! Injected faults of what rays leave out by single voxels: the runs of a set of voxels and its octree.

use super::Fault::{self, Shader};

const RUNS: &str = "relation.skipped_by_runs.raycast.ray.composite.perspective";
const OCTREE: &str = "relation.skipped_by_octree.raycast.ray.composite.perspective";
/// The same of rays from the beginning of rows to their ends.
const RUNS_UP: &str = "relation.skipped_by_runs.raycast.ray.composite.orthographic";
const OCTREE_UP: &str = "relation.skipped_by_octree.raycast.ray.composite.orthographic";

/// Classified voxels of shear-warp: their runs, and what is made between them.
const CLASSIFIED: &str = "relation.runs.shear_warp.composite.nearest.perspective";
const CLASSIFIED_BETWEEN: &str = "relation.runs.shear_warp.composite.linear_fetch.along_z";
const CLASSIFIED_ALONG_ROWS: &str = "relation.runs.shear_warp.composite.linear_fetch.along_x";
const CLASSIFIED_ALONG_Y: &str = "relation.runs.shear_warp.composite.linear_fetch.along_y";

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
    (
        "the last classified voxel of a word of 32 is always empty",
        Shader(
            "lib/channels_on_runs.wgsl",
            "in_run_texels(number), 0).xy;",
            "in_run_texels(number), 0).xy & vec2(0x7fffffffu, 0xffffffffu);",
        ),
        CLASSIFIED,
    ),
    (
        "payloads are counted from those before the next word",
        Shader(
            "lib/channels_on_runs.wgsl",
            "let rank = word.y + countOneBits",
            "let rank = textureLoad(run_words, in_run_texels(number + 1u), 0).y + countOneBits",
        ),
        CLASSIFIED,
    ),
    (
        "a classified voxel counts itself",
        Shader(
            "lib/channels_on_runs.wgsl",
            "countOneBits(word.x & (bit - 1u))",
            "countOneBits(word.x & (bit | (bit - 1u)))",
        ),
        CLASSIFIED,
    ),
    (
        "rows of classified voxels end with their last whole word",
        Shader(
            "lib/channels_on_runs.wgsl",
            "(dims.x + RUN_WORD_VOXELS - 1u) / RUN_WORD_VOXELS",
            "dims.x / RUN_WORD_VOXELS",
        ),
        CLASSIFIED,
    ),
    (
        "the device finds the last voxel of a word of 32 empty",
        Shader("run_words.wgsl", "bit < count;", "bit < min(count, 31u);"),
        CLASSIFIED,
    ),
    (
        "the device counts the full voxels of a word among those before it",
        Shader(
            "run_words.wgsl",
            "counts[thread].x - own.x",
            "counts[thread].x",
        ),
        CLASSIFIED,
    ),
    (
        "blocks of words of full voxels begin as if none came before",
        Shader(
            "run_payload.wgsl",
            "word.y + run_list.d[run_build.texel_count + block.x].x",
            "word.y",
        ),
        CLASSIFIED,
    ),
    (
        "the device puts payloads of full voxels one place too far",
        Shader(
            "run_payload.wgsl",
            "rank - run_build.first_rank",
            "rank + 1u - run_build.first_rank",
        ),
        CLASSIFIED,
    ),
    (
        "the last block of words of full voxels is not summed up",
        Shader(
            "run_blocks.wgsl",
            "min((thread + 1u) * share, run_build.block_count)",
            "min((thread + 1u) * share, run_build.block_count - 1u)",
        ),
        CLASSIFIED,
    ),
    (
        "behind the end of a row lies an empty classified voxel",
        Shader(
            "lib/channels_on_runs.wgsl",
            "select(taps.max, slice, across)",
            "select(taps.min + 1, slice, across)",
        ),
        CLASSIFIED_BETWEEN,
    ),
    (
        "between classified voxels both axes of a slice have one weight",
        Shader(
            "lib/channels_on_runs.wgsl",
            "lerp_color(above, below, part.y)",
            "lerp_color(above, below, part.x)",
        ),
        CLASSIFIED_BETWEEN,
    ),
    (
        "across rows of classified voxels the second axis is the first",
        Shader(
            "lib/channels_on_runs.wgsl",
            "select(vec3(high.x, low.yz), vec3(low.x, high.y, low.z), axis == 0u)",
            "vec3(high.x, low.yz)",
        ),
        CLASSIFIED_ALONG_ROWS,
    ),
    (
        "classified voxels are weighed by another axis than they lie along",
        Shader(
            "lib/channels_on_runs.wgsl",
            "select(weight.z, weight.y, axis == 2u)",
            "weight.y",
        ),
        CLASSIFIED_ALONG_Y,
    ),
];
