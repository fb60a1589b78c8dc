//! What a person asks the program for, one feature a row: the words of the command line, and the inputs that can show it.

use super::inputs::{ALL, Input, VOLUMES};

/// Something that words ask for beside the input. What holds without a word (ray casting, composites, perspective) is no
/// feature: every pair without a word for it has it.
pub struct Feature {
    /// Of features with the same choice a command line holds one.
    pub choice: &'static str,
    /// What it is.
    pub name: &'static str,
    /// The words; `{place}`, `{clip}`, `{thick}`, `{window}` and `{ground}` are those of the input ([`Input::fill`]).
    pub words: &'static str,
    /// The inputs that have it, the best first.
    pub inputs: &'static [Input],
    /// False where a picture is the same with it.
    pub is_seen: bool,
}

const fn feature(choice: &'static str, name: &'static str, words: &'static str) -> Feature {
    Feature {
        choice,
        name,
        words,
        inputs: ALL,
        is_seen: true,
    }
}

const fn of(inputs: &'static [Input], feature: Feature) -> Feature {
    Feature { inputs, ..feature }
}

const fn unseen(feature: Feature) -> Feature {
    Feature {
        is_seen: false,
        ..feature
    }
}

/// All of them, in the order of the page.
pub const FEATURES: &[Feature] = &[
    feature("technique", "3D slices", "--technique slices-3d"),
    feature("technique", "2D stacks", "--technique slices-2d"),
    feature(
        "technique",
        "interpolated 2D stacks",
        "--technique slices-2d --smooth",
    ),
    feature("technique", "shear-warp", "--technique shear-warp"),
    // Scattered points are splats without a word.
    of(VOLUMES, feature("technique", "splats", "--technique splat")),
    feature("technique", "path tracing", "--technique pathtrace --spp 2"),
    of(
        &[Input::Head],
        feature(
            "technique",
            "path-traced surfaces",
            "--technique pathtrace --spp 2 --iso 300",
        ),
    ),
    feature("mode", "maximum", "--mode mip"),
    feature("mode", "mean", "--mode average"),
    feature("mode", "X-ray", "--mode xray"),
    feature("mode", "local maximum", "--mode lmip"),
    feature("mode", "MIDA", "--mode mida"),
    feature("mode", "surfaces", "--mode iso"),
    feature(
        "classified",
        "pre-integrated classification",
        "--preintegrated",
    ),
    feature("classified", "pre-classification", "--preclassified"),
    feature("jitter", "jitter", "--jitter"),
    unseen(feature("octree", "octree", "--empty-space octree")),
    feature("filter", "nearest filter", "--filter nearest"),
    feature("filter", "cubic filter", "--filter cubic"),
    // Lines have four rays a pixel without a word.
    feature("aa", "nine rays a pixel", "--aa 9"),
    feature("light", "light", "--shading phong --material 0.1,0.9,0,1"),
    feature("occlusion", "ambient occlusion", "--ambient-occlusion 0.9"),
    feature(
        "light",
        "shadows",
        "--shading phong --shadows volume --light 1,-1,1",
    ),
    feature("scattering", "single scattering", "--scattering single"),
    feature(
        "function",
        "function of value and gradient",
        "--preset boundaries",
    ),
    feature("function", "colour map", "--colormap magma"),
    feature("window", "window", "--window {window}"),
    feature("labels", "labels", "--labels labels{place}.nrrd"),
    feature(
        "with",
        "another volume",
        "--with other{place}.nrrd,color=red,window=0:255",
    ),
    feature(
        "shape",
        "a surface beside the volume",
        "--with bar{place}.stl,color=orange",
    ),
    feature(
        "opacity",
        "opacity by another volume",
        "--opacity-from other{place}.nrrd",
    ),
    of(
        &[Input::Cells],
        feature(
            "input",
            "channels",
            "--channel 0,color=cyan,window=0:1 --channel 1,color=red,window=0:1",
        ),
    ),
    of(
        &[Input::Colors],
        unseen(feature("input", "a volume of colours", "")),
    ),
    of(
        &[Input::Points],
        unseen(feature("input", "scattered points", "")),
    ),
    of(
        &[Input::Points],
        feature(
            "input",
            "scattered points as spheres",
            "--points-as spheres",
        ),
    ),
    of(
        &[Input::Points],
        feature("input", "scattered points as a field", "--points-as field"),
    ),
    of(
        &[Input::Points],
        unseen(feature(
            "input",
            "scattered points on a grid",
            "--points-as grid --grid 16x16x12",
        )),
    ),
    feature("denoise", "noise filter", "--denoise gaussian"),
    feature("clip", "clip plane", "--clip {clip}"),
    feature("crop", "crop", "--crop 1,13,0,99,0,99"),
    feature("crop", "cut faces", "--crop 1,13,0,99,0,99 --cut-faces"),
    feature("camera", "section", "--section axial"),
    feature(
        "camera",
        "sections of three directions",
        "--section axial,coronal,sagittal",
    ),
    feature(
        "camera",
        "thick section",
        "--section axial --thickness {thick}",
    ),
    feature("side", "view from the left", "--view left"),
    feature(
        "projection",
        "orthographic view",
        "--projection orthographic",
    ),
    of(
        &[Input::Storm, Input::Earth],
        feature("flow", "lines of the wind", "--flow stream"),
    ),
    of(
        &[Input::Earth],
        feature("map", "lines of the map", "--map graticule=1"),
    ),
    of(
        &[Input::Storm, Input::Earth],
        feature("barbs", "wind barbs", "--barbs"),
    ),
    of(
        &[Input::Storm, Input::Earth],
        feature("ground", "a field on the ground", "--ground {ground}"),
    ),
    unseen(feature("film", "turntable", "--turntable 2")),
    of(
        &[Input::Storm],
        unseen(feature("film", "film of all times", "--times")),
    ),
    feature("layer", "layer of depths", "--aov depth"),
    feature("annotation", "annotation", "--annotate"),
    unseen(feature("stream", "brick by brick", "--stream")),
    feature("device", "CPU reference", "--device reference"),
];

/// Pairs whose picture is that of the second alone, since it has the first without a word: fields of the weather are
/// pre-integrated, sections show means, and spheres are the host's on every device.
pub const GIVEN: &[[&str; 2]] = &[
    ["pre-integrated classification", "lines of the wind"],
    ["pre-integrated classification", "lines of the map"],
    ["pre-integrated classification", "wind barbs"],
    ["pre-integrated classification", "a field on the ground"],
    ["pre-integrated classification", "film of all times"],
    [
        "pre-integrated classification",
        "scattered points on a grid",
    ],
    ["CPU reference", "scattered points as spheres"],
    ["mean", "section"],
    ["mean", "sections of three directions"],
    ["mean", "thick section"],
];
