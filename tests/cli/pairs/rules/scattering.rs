//! Single scattering.

use super::{Rule, no_meaning, not_built, of};

/// In their order.
pub const RULES: &[Rule] = &[
    no_meaning(
        "--bounces 1 scatters once too",
        "paths scatter as often as `--bounces` says, once too",
    ),
    of(
        &["scattered points"],
        no_meaning(
            "single scattering is for ray casting",
            "scattered points are splats, each an amount of matter that hides nothing",
        ),
    ),
    no_meaning(
        "single scattering is for composite",
        "a projection and a surface are one number a ray, in which nothing scatters",
    ),
    no_meaning(
        "single scattering is for light that",
        "light that scatters is all the light there is, and matter is in its way already",
    ),
    not_built(
        "single scattering is for ray casting",
        "a slice, a base pixel or a splat would ask the light volume, 8 numbers a fragment and light, for each of 443 slices of 256^3 \
         voxels",
    ),
    not_built(
        "single scattering is for samples that are points",
        "light changes along a slab: a table over both ends and what comes through to them, 256^3 entries or 128 MiB",
    ),
    not_built(
        "single scattering is for empty space by macro cells",
        "each step of light that is followed from a sample would go down the octree, log2 n levels in place of one look",
    ),
    not_built(
        "single scattering is for the filters nearest and linear",
        "64 fetches in place of 8 a sample and a step of light",
    ),
    not_built(
        "single scattering is for what lies behind cuts",
        "a face has no depth in which light scatters: it would be a surface, which paths light by 1 sample a light and pixel more",
    ),
    not_built(
        "single scattering is for one volume of numbers",
        "all volumes in the way of each light: 8 fetches more a sample and volume, and as many for each look at a cell of the light volume",
    ),
    not_built(
        "--stream is not for --scattering single",
        "light goes through the whole volume first: the file is read twice",
    ),
];
