//! Why pairs are refused: by what the program says, whether the pair means nothing or is not built, and what it would cost.

/// A kind of refusal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// No picture could be both.
    NoMeaning,
    /// A picture could be both; the reason says what it would cost.
    NotBuilt,
    /// Drawn with these words more, which the program asks for.
    NeedsMore(&'static str),
}

/// A reason for pairs.
pub struct Rule {
    /// Its kind.
    pub class: Class,
    /// A part of what the program says.
    pub says: &'static str,
    /// One of the pair is one of these features; any where there are none.
    pub of: &'static [&'static str],
    /// The reason.
    pub why: &'static str,
}

const fn no_meaning(says: &'static str, why: &'static str) -> Rule {
    Rule {
        class: Class::NoMeaning,
        says,
        of: &[],
        why,
    }
}

const fn not_built(says: &'static str, why: &'static str) -> Rule {
    Rule {
        class: Class::NotBuilt,
        ..no_meaning(says, why)
    }
}

const fn needs(says: &'static str, more: &'static str, why: &'static str) -> Rule {
    Rule {
        class: Class::NeedsMore(more),
        ..no_meaning(says, why)
    }
}

const fn of(features: &'static [&'static str], rule: Rule) -> Rule {
    Rule {
        of: features,
        ..rule
    }
}

const PROJECTIONS: &[&str] = &["maximum", "mean", "X-ray", "local maximum"];
const POINTS: &[&str] = &["scattered points"];
const SPHERES: &[&str] = &["scattered points as spheres"];

/// The first that fits is the reason of a pair.
pub const RULES: &[Rule] = &[
    // Sections.
    needs(
        "--section draws --mode average unless a mode is given",
        "--mode composite",
        "a section shows the mean of its values; as a composite it has colours, opacities and light",
    ),
    needs(
        "--section without --thickness is one sample a ray",
        "--thickness 60",
        "a surface lies between two samples, and a section without a thickness has one",
    ),
    no_meaning(
        "--section takes its samples on the cut",
        "a section has its samples on the plane, and those of the other lie elsewhere",
    ),
    of(
        &["orthographic view"],
        no_meaning(
            "cannot be used with '--section <PLANE>'",
            "a section is orthographic already",
        ),
    ),
    of(
        &["view from the left"],
        no_meaning(
            "cannot be used with '",
            "a section is seen from straight in front of its plane",
        ),
    ),
    no_meaning(
        "--section looks straight at its plane",
        "a turning camera leaves the plane, which is seen from straight in front",
    ),
    no_meaning(
        "--aov is of one view, and --section has several planes",
        "all that is seen on a plane is as deep as the plane",
    ),
    of(
        SPHERES,
        no_meaning(
            "with --section: lines lie beside a cut",
            "a section is of a volume, and spheres are none",
        ),
    ),
    of(
        &["lines of the map", "thick section"],
        not_built(
            "with --section: lines lie beside a cut",
            "lines cut by the planes of a slab: two tests more a line and ray, of lines of some 15 000 vertices; on a level of the \
             Earth the map would have to be drawn at the height of the plane",
        ),
    ),
    no_meaning(
        "with --section: lines lie beside a cut",
        "lines go through a plane at single points",
    ),
    of(
        &["turntable"],
        no_meaning(
            "and only `render` draws that",
            "a turning camera leaves the planes, which are seen from straight in front",
        ),
    ),
    not_built(
        "and only `render` draws that",
        "films of several planes: as many cameras a frame as there are planes, where a film keeps one",
    ),
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
    // Techniques.
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
            "geometry in the picture is for rays through the same places of all pixels",
            "a technique is for the samples of a volume, and spheres are none",
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
        "geometry in the picture is for rays through the same places of all pixels",
        "slices and splats between lines: a test against a depth of 4 bytes a pixel for each slice, 443 times a picture of 256^3 \
         voxels; shear-warp has no depth at its base pixels",
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
        "--preclassified is for one number a voxel in --mode composite, and occlusion is of values",
        "light through opacities that voxels keep: the passes of the light volume for a second kind of voxels, at the cost of the \
         first, 12 s for occlusion in 256 x 256 x 108 voxels on two cores (light.md)",
    ),
    not_built(
        "--preclassified is for one number a voxel",
        "as many volumes of colours as there are volumes: 4 numbers a voxel and volume in place of 1",
    ),
    // Several volumes.
    not_built(
        "--ambient-occlusion and --shadows volume are for one number a voxel",
        "light through all volumes, each classified where light goes: n times the 12 s that occlusion of 256 x 256 x 108 voxels takes \
         on two cores (light.md)",
    ),
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
    // Points.
    of(
        &["scattered points", "scattered points as spheres"],
        no_meaning(
            "is for volumes, and",
            "scattered points have neither voxels nor a grid",
        ),
    ),
    no_meaning(
        "spheres are no volume",
        "spheres are surfaces, lit already: a ray takes no samples of them",
    ),
    // Brick by brick.
    of(
        &["scattered points", "scattered points as spheres"],
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
        "--stream is not for --flow, --map, --barbs and --ground",
        "the depth of lines would be read by each brick: 4 bytes a pixel and brick",
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
    not_built(
        "the CPU references draw volumes alone",
        "each ray against each of some 15 000 round cones on the host, without the lists that the device keeps of them a tile",
    ),
];
