//! Path tracing.

use super::{Rule, no_meaning, not_built, of};

/// In their order.
pub const RULES: &[Rule] = &[
    no_meaning(
        "path tracing is for collisions at random places, and no lattice",
        "light is scattered at random places: there are neither slabs between two nor steps that could be moved",
    ),
    no_meaning(
        "path tracing is for light that scatters",
        "light that scatters is all the light there is: surfaces, shadows and occlusion are in it",
    ),
    of(
        &["nine rays a pixel"],
        no_meaning(
            "path tracing is for rays at random places of the pixel",
            "each path goes through a place of its own in the pixel",
        ),
    ),
    not_built(
        "path tracing is for the filters nearest and linear",
        "a cubic filter: 64 fetches in place of 8 at each of the collisions that are tried, several for one that is real",
    ),
    not_built(
        "path tracing is for what lies behind cuts",
        "a face is a surface that light falls on from all around: each flight of each path against the planes of the cut",
    ),
    not_built(
        "a path-traced surface of values is for one volume under a function of the value",
        "labels of each voxel around each piece of a surface, 8 fetches more, and no surface between a label that is hidden and one that is not",
    ),
    not_built(
        "path tracing is for volumes of numbers and labels on one grid",
        "volumes on other grids and colours: a place in each grid wherever a collision is tried, 96 shader variants more; and what of a colour is albedo",
    ),
];
