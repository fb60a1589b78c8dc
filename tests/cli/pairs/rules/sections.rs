//! Sections and slabs.

use super::{Rule, needs, no_meaning, not_built, of};

const SPHERES: &[&str] = &["scattered points as spheres"];

/// In their order.
pub const RULES: &[Rule] = &[
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
            "with --section: a section is of a volume",
            "a section is of a volume, and spheres are none",
        ),
    ),
    of(
        &["a surface beside the volume"],
        needs(
            "a plane meets a surface in a line without a width",
            "--thickness 60",
            "a surface of triangles has no thickness, and a section without one meets it in a line",
        ),
    ),
    no_meaning(
        "it stands at a height of its own, and not in the plane",
        "barbs and the ground stand at a height, and a section is a plane",
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
];
