//! Modes: projections show a number, which is classified after the ray, and surfaces have nothing between them.

use super::{Rule, needs, no_meaning, not_built, of};

const PROJECTIONS: &[&str] = &["maximum", "mean", "X-ray", "local maximum"];

/// In their order.
pub const RULES: &[Rule] = &[
    // Projections show a number, which is classified after the ray.
    no_meaning(
        "no light falls on a projection",
        "a projection is one number a ray, on which no light falls",
    ),
    no_meaning(
        "a projected value has no gradient",
        "a projection is one number a ray, which has no gradient",
    ),
    no_meaning(
        "--preclassified is for one number a voxel in --mode composite, and this is another mode",
        "other modes look at values, and a classified voxel has a colour",
    ),
    of(
        PROJECTIONS,
        no_meaning(
            "needs --mode composite: the others show one number a ray",
            "a projection has no opacities along the ray",
        ),
    ),
    of(
        PROJECTIONS,
        no_meaning(
            "is for composite, not for mode",
            "a projection classifies one number a ray: nothing is hidden along the ray, or lies between two of its colours",
        ),
    ),
    no_meaning(
        "--aov depth needs a mode with a depth",
        "an integral and a splat lie at no one depth",
    ),
    no_meaning(
        "--mode xray: the integral of a colour has no window",
        "a colour is no number to be integrated",
    ),
    needs(
        "the range of the integrals is not known",
        "--window 0,90000",
        "a colour map is spread over a window, and the range of integrals is known when the picture is drawn",
    ),
    // Surfaces.
    no_meaning(
        "jitter is for modes of samples, not for surfaces",
        "where a surface lies does not depend on where steps begin",
    ),
    of(
        &["surfaces"],
        no_meaning(
            "is for composite, not for mode iso",
            "a surface is where the volume has a value, with nothing inside: it has no slabs, no opaque faces and no empty voxels",
        ),
    ),
    of(
        &["MIDA"],
        no_meaning(
            "empty space by an octree or by runs is for composite, not for mode mida",
            "a sample that nobody sees still clears what lies before it where its value is a new maximum",
        ),
    ),
    of(
        &["MIDA"],
        not_built(
            "is for composite, not for mode mida",
            "a sample of MIDA weakens what lies before it by how much it exceeds the maximum so far: a slab has no integral of its own, \
             and a table over both ends and that maximum has 256^3 entries, 128 MiB",
        ),
    ),
    of(
        &["MIDA", "surfaces"],
        not_built(
            "needs --mode composite: the others show one number a ray",
            "opacities of another volume: 8 fetches more a sample, and the 240 shader variants that composites of several volumes have",
        ),
    ),
    not_built(
        "draws several volumes, and --mode",
        "maxima or surfaces of each volume along one ray: 8 fetches and 4 numbers more a sample and volume, and the 240 shader \
         variants that composites of several volumes have",
    ),
    not_built(
        "shows one number a voxel, and several channels are drawn",
        "maxima or surfaces of each channel along one ray: 8 fetches and 4 numbers more a sample and channel, and 54 shader \
         variants a mode, as projections of one number have",
    ),
];
