//! Several volumes, colours and channels.

use super::{Rule, no_meaning, not_built};

/// In their order.
pub const RULES: &[Rule] = &[
    not_built(
        "--filter cubic reads one number a voxel, and several are drawn",
        "64 fetches a sample and volume in place of 8, 4 bytes a prefiltered voxel, and 240 shader variants more",
    ),
    not_built(
        "empty space by an octree or by runs is for one volume of numbers",
        "an octree of what any of the volumes shows: all of them are read on the host where a function changes, n times as long for n",
    ),
    not_built(
        "widgets and gradient opacity are for one volume alone",
        "a gradient of each volume: 6 samples more a sample and volume, 48 fetches in place of 8",
    ),
    no_meaning(
        "is for one number a voxel, and several are drawn",
        "each channel has a function of its own: `--channel 0,color=cyan`",
    ),
    no_meaning(
        "colours numbers, and this volume has its own colours",
        "a volume of colours needs no function to colour it",
    ),
    not_built(
        "goes with volumes of numbers, and this one is of colours",
        "colours and numbers mixed: 240 shader variants more, as composites of colours and of numbers have each",
    ),
    not_built(
        "makes one number a voxel opaque, and several are drawn",
        "an opacity over mixed channels: 8 fetches more a sample, in 240 shader variants",
    ),
    not_built(
        "the steepest gradient of several times is not known",
        "all times are read once more before the first frame: twice the time of reading",
    ),
];
