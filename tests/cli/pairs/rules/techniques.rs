//! Techniques: what slices, base planes and splats have no room for.

use super::{Rule, needs, no_meaning, not_built, of};

const POINTS: &[&str] = &["scattered points"];
const SPHERES: &[&str] = &["scattered points as spheres"];

/// In their order.
pub const RULES: &[Rule] = &[
    no_meaning(
        "jitter is for ray casting",
        "slices lie on planes that all pixels share; a pixel has no steps of its own",
    ),
    no_meaning(
        "a lattice of rays is for ray casting, not for shear-warp",
        "a ray of the base plane is shared by some four pixels, which would share the grain",
    ),
    no_meaning(
        "empty space by an octree or by runs is for ray casting",
        "an octree says how far a ray may go; slices and splats go through the volume once for all pixels",
    ),
    no_meaning(
        "no lattice of rays, not for the lattice jitter",
        "splats are put together in sheets that all pixels share",
    ),
    no_meaning(
        "splatting is for its own kernel",
        "a splat is a kernel already, of the width of `--splat-std`",
    ),
    no_meaning(
        "splatting is for what lies behind cuts",
        "a Gaussian ends nowhere, and has no face",
    ),
    needs(
        "image-aligned sheets that a slice of splats reaches into",
        "--samples-per-voxel 0.2",
        "levels far apart reach through many sheets that are as thick as columns are wide, more than there is room for",
    ),
    no_meaning(
        "splatting is for samples that are sheets, not for pre-integrated classification",
        "a sheet holds all of a slab: nothing lies between two of them",
    ),
    of(
        POINTS,
        no_meaning(
            "not for mode",
            "scattered points are splats, each an amount of matter: their sum has no surfaces and no order along a ray",
        ),
    ),
    of(
        POINTS,
        no_meaning(
            "splatting is for matter that is not lit",
            "a point has no surface that light could fall on, and its Gaussian hides nothing",
        ),
    ),
    of(
        POINTS,
        no_meaning(
            "splatting is for functions of the value alone",
            "values of scattered points have no gradient",
        ),
    ),
    of(
        POINTS,
        no_meaning(
            "--aov depth needs --technique raycast",
            "a Gaussian has no first place where it is hit",
        ),
    ),
    of(
        SPHERES,
        no_meaning(
            "a technique is of the samples of a volume",
            "spheres have no samples, and are drawn before any technique",
        ),
    ),
    of(
        &["path tracing"],
        not_built(
            "geometry in the picture is for rays or slices that end where it is drawn",
            "light that lines reflect: each flight of each path against some 15 000 round cones, in a tree that the device goes down",
        ),
    ),
    not_built(
        "in it a sample depends on those before it",
        "a slice would read what those before it left: a barrier for each of 443 slices of 256^3 voxels, in place of one draw",
    ),
    not_built(
        "shear-warp is for composite, mip, minip, average and xray, not for mode",
        "modes of rays through base pixels, 18 to 48 shader variants each; edges of surfaces would be as soft as a base pixel, a voxel",
    ),
    not_built(
        "splatting is for the modes composite, mip, minip, average and xray",
        "sheets would keep the state of a ray, up to 5 numbers a pixel, and read it for each of 443 sheets of 256^3 voxels",
    ),
    not_built(
        "splatting is for matter that is not lit",
        "a lit splat has a normal: 3 numbers a voxel beside its 1, and shadows take a pass a sheet",
    ),
    not_built(
        "splatting is for functions of the value alone",
        "sheets would keep gradients: 4 numbers a pixel in place of 1, at four times the bandwidth",
    ),
    not_built(
        "splatting is for one volume of numbers",
        "a sheet of each volume: as many targets as there are volumes, and a pass more a sheet that mixes them, 443 for 256^3 voxels",
    ),
    not_built(
        "an opaque cut face is for ray casting",
        "faces are where a ray enters the box: slices would draw them as polygons beside the slices, and the base plane of shear-warp \
         would blur their edges by a voxel",
    ),
    not_built(
        "geometry in the picture is for rays or slices that end where it is drawn",
        "shear-warp has no depth at its base pixels: geometry would be drawn for them, as soft as a base pixel, a voxel",
    ),
    not_built(
        "--aov depth needs --technique raycast",
        "the blend unit keeps no depth: a second target of 4 bytes a pixel that each of 443 slices of 256^3 voxels tests and writes",
    ),
    not_built(
        "volumes on grids of their own is for ray casting and 3D slices",
        "a slice of one grid cuts across the slices of the other: 8 fetches in place of 4 a sample, which is what 3D slices do",
    ),
    not_built(
        "interpolation between slices is for one volume of numbers",
        "two slices and two stacks of each volume: 8 fetches more a sample and volume, and the 48 shader variants of 2D stacks of \
         several volumes",
    ),
    not_built(
        "interpolation between slices is for nearest and linear filters",
        "a cubic filter between slices is that of 3D slices: 64 fetches a sample in place of 8",
    ),
    not_built(
        "interpolation between slices is for functions of the value alone",
        "gradients between slices: 6 more samples of two slices each, 48 fetches a sample in place of 8",
    ),
];
