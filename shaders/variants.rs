//! Which shaders are compiled, and with what: every slot of an `#import` name and the words that fill it. Part of
//! `build.rs`.

use std::collections::BTreeMap;

/// A slot of `#import` names and the words that fill it.
#[derive(Clone, Copy, Debug)]
pub struct Slot {
    pub name: &'static str,
    pub words: &'static [&'static str],
    /// A specialization constant chooses the word: all of them are in one module.
    pub is_constant: bool,
}

/// A slot of which each word makes modules of its own.
const fn slot(name: &'static str, words: &'static [&'static str]) -> Slot {
    Slot {
        name,
        words,
        is_constant: false,
    }
}

/// A slot whose word a specialization constant chooses.
const fn constant(name: &'static str, words: &'static [&'static str]) -> Slot {
    Slot {
        name,
        words,
        is_constant: true,
    }
}

impl Slot {
    /// The name of its constant in WGSL.
    pub fn constant(&self) -> String {
        self.name.to_uppercase()
    }
}

/// Names of the specialization constants: the place of one is its `SpecId`. The first says whether the driver is
/// llvmpipe (`opaque_predicates.rs`).
pub const CONSTANTS: &[&str] = &[
    "software", "filter", "holes", "lattice", "cuts", "transfer", "end", "mode", "kernel",
    "operator", "blend", "output", "topology", "layers", "sheets", "take", "grids", "light",
    "space", "matter", "levels", "found",
];

/// The name of an import with its slots filled. `{slot=word}` has that word where an entry has no such slot.
pub fn filled(name: &str, fills: &BTreeMap<&str, &str>) -> String {
    let mut parts = name.split('{');
    let mut filled = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (slot, rest) = part.split_once('}').expect("a slot ends");
        let (slot, word) = slot.split_once('=').unwrap_or((slot, ""));
        filled += fills.get(slot).unwrap_or(&word);
        filled += rest;
    }
    filled
}

/// A kernel is wider than linear, by fetches; a spline is a B-spline by the sampler.
const FILTER: Slot = constant(
    "filter",
    &["nearest", "linear", "linear_fetch", "kernel", "spline"],
);
/// By corners too, of 8-bit and of 16-bit voxels: what rays on their own lattice have on software devices.
const CORNERS: Slot = slot("filter", &["footprint8", "footprint16"]);
/// Conformance pictures search the points, and never leave filtering to the device.
const FETCHED: Slot = constant("filter", &["nearest", "linear_fetch", "kernel"]);
/// Several volumes are mixed by narrow filters.
const NARROW: Slot = constant("filter", &["nearest", "linear", "linear_fetch"]);
const NARROW_FETCHED: Slot = constant("filter", &["nearest", "linear_fetch"]);
const LINEAR: Slot = slot("filter", &["linear"]);
const TABLE: Slot = slot("transfer", &["table"]);
/// What goes with corners: devices whose sampler is a program.
const STORED: Slot = slot("transfer", &["stored"]);
const POINTS: Slot = slot("transfer", &["points"]);
/// One number at both ends of a segment. The word is left out of names.
const SLAB: Slot = slot("inputs", &["slab"]);
/// One number, and where it was taken between the slices of a stack. The words are left out of names.
const BETWEEN: Slot = slot("inputs", &["between"]);
const STACK_PLACE: Slot = slot("place", &["between"]);
/// Central differences and unhindered light, and no more: drivers on CPUs go through all that there is for each sample.
const TEXEL_PLACE: Slot = slot("place", &["texels"]);
const UNHINDERED: Slot = slot("lamps", &["light_unhindered"]);
/// What a compute pass walks along: a line of samples, one of slabs, or the slices of a stack, by points and by slabs.
const LINE: Slot = slot("walk", &["march"]);
const SLABS: Slot = slot("walk", &["march_slab"]);
const SLICES: Slot = slot("walk", &["march_stack"]);
const SLICE_SLABS: Slot = slot("walk", &["march_stack_slab"]);
/// The lattice of the slices of a stack, walked along for their depth.
const STACK: Slot = slot("lattice", &["stack"]);
/// Where samples of slices end: where the domain does, or at a host's depth too. Slices that are tested against a host's
/// depth buffer are hidden behind it without reading it.
const TESTED: Slot = slot("end", &["domain"]);
const END: Slot = constant("end", &["domain", "host_depth"]);
/// How central differences are made. The words are left out of names: filters by footprint texels have their own way, and
/// it is theirs alone.
const TAPS: Slot = slot("differences", &["taps"]);
const SHARED: Slot = slot("differences", &["footprint"]);
/// Words that stand in no name.
pub const SILENT: &[&str] = &[
    "scalar",
    "level",
    "slab",
    "domain",
    "march",
    "march_slab",
    "march_stack",
    "march_stack_slab",
    "taps",
    "footprint",
    "uniform",
    "cut",
    "triangles",
    "layers",
    "shared",
    "unlit",
    "cells",
    "between",
    "texels",
    "light_unhindered",
    "no_levels",
    "by_value",
];
/// Who reads the parameters of slices: the fragments, or the vertices for them (`flat_varyings.rs`).
const PARAMETERS: Slot = slot("parameters", &["uniform", "planes", "stack"]);
/// Whether clip planes cut the domain, cut faces are seen, rays have places of their own in their pixels or begin by a part
/// of a step earlier: or nothing of it.
const CUTS: Slot = constant("cuts", &["cut", "whole"]);
/// Whether rays leave depth, value and number of samples beside the picture, and what bricks behind go on with, or paths their
/// layers: or the picture alone.
const LAYERS: Slot = constant("layers", &["layers", "picture"]);
/// What says where nothing is seen. The word `cells` is left out of names.
const SPACE: Slot = constant("space", &["cells", "octree", "runs"]);
const PLANES: Slot = slot("parameters", &["planes"]);
const STACKED: Slot = slot("parameters", &["stack"]);
/// The primitives that patches are drawn as.
const TOPOLOGY: Slot = constant("topology", &["triangles", "points"]);
/// What conformance pictures search, beside the table.
const TRANSFER: Slot = constant("transfer", &["table", "points"]);
const HOLES: Slot = constant("holes", &["none", "mask"]);
const LATTICE: Slot = constant("lattice", &["ray", "planes", "bresenham"]);
/// Those that have slabs.
const SLAB_LATTICE: Slot = constant("lattice", &["ray", "planes"]);
/// One number a voxel, without or with its gradient. The word `scalar` is left out of names.
const ONE: Slot = slot("inputs", &["scalar", "scalar_gradient"]);
/// With a gradient for no more than unhindered light and weights of opacity, by central differences.
const LEAN: Slot = slot("inputs", &["shaded", "gradient_opacity"]);
/// Whether paths meet surfaces of values.
const LEVELS: Slot = constant("levels", &["no_levels", "levels"]);
/// What collisions of paths find: by one value, by its gradient too, or by several values. The word `by_value` is left out of names.
const FOUND: Slot = constant("found", &["by_value", "by_gradient", "by_channels"]);
const FOUND_IN_ONE: Slot = constant("found", &["by_value", "by_gradient"]);
/// Light that is scattered once.
const SCATTERED: Slot = slot("inputs", &["scattered"]);
const SCALAR: Slot = slot("inputs", &["scalar"]);
/// The field of scattered points, which has no voxels and no filter.
const FIELD: Slot = slot("inputs", &["field"]);
/// Steps that adapt to what is there, of volumes without holes.
const ADAPTIVE: Slot = slot("inputs", &["adaptive"]);
const WHOLE: Slot = slot("holes", &["none"]);
/// Whether volumes that are mixed lie on the grid of the first, or on grids of their own.
const GRIDS: Slot = constant("grids", &["shared", "own"]);
/// The same of volumes of colours, which may be classified voxels in runs.
const COLOR_GRIDS: Slot = constant("grids", &["shared", "own", "runs"]);
/// Whether light falls on slabs, and on samples between slices.
const LIGHT: Slot = constant("light", &["unlit", "lit"]);
/// The same of volumes that are mixed, where light may be hindered on its way.
const MIXED_LIGHT: Slot = constant("light", &["unlit", "lit", "hindered"]);
/// What is in the way of light, where it is more than one volume.
const MATTER: Slot = constant("matter", &["of_channels", "of_colors"]);
const MIXED: Slot = slot("inputs", &["channels", "colors"]);
const CHANNELS: Slot = slot("inputs", &["channels"]);
const COLORS: Slot = slot("inputs", &["colors"]);
const MODE: Slot = slot("mode", &["composite"]);
/// Modes that slicers do not have leave the lattice of slicers to them.
const RAY: Slot = slot("lattice", &["ray"]);
/// One number a ray.
const PROJECTED: Slot = constant("mode", &["mip", "minip", "sum", "lmip", "attenuated_mip"]);
const MIDA: Slot = slot("mode", &["mida"]);
const BLEND: Slot = slot("blend", &["composite"]);
/// What projections have blended, an extreme or a sum, and the number of samples.
const NUMBER: Slot = constant("blend", &["number", "count"]);

/// How splats are put together.
const SHEETS: Slot = constant("sheets", &["image", "axis", "each"]);

/// The wanted combinations. Order of the slots is the order of words in a variant's name.
pub const ENTRIES: &[(&str, &[Slot])] = &[
    (
        "raycast",
        &[
            LINE, MODE, ONE, LATTICE, FILTER, HOLES, TABLE, TAPS, SPACE, LAYERS,
        ],
    ),
    (
        "raycast",
        &[
            LINE, MODE, ONE, LATTICE, CORNERS, HOLES, STORED, SHARED, SPACE, CUTS, LAYERS,
        ],
    ),
    (
        "raycast",
        &[
            LINE, MODE, LEAN, LATTICE, NARROW, HOLES, TABLE, TAPS, SPACE, LAYERS,
        ],
    ),
    (
        "raycast",
        // With layers in any case: on llvmpipe a lit picture alone was found to take 2 % longer.
        &[
            LINE, MODE, LEAN, LATTICE, CORNERS, HOLES, STORED, SHARED, SPACE, CUTS,
        ],
    ),
    (
        "raycast",
        &[
            LINE,
            MODE,
            SCATTERED,
            SLAB_LATTICE,
            NARROW,
            HOLES,
            TRANSFER,
            LAYERS,
        ],
    ),
    (
        "raycast",
        &[LINE, MODE, ADAPTIVE, RAY, NARROW, WHOLE, TABLE, LAYERS],
    ),
    (
        "raycast",
        &[
            LINE, MODE, ADAPTIVE, RAY, CORNERS, WHOLE, STORED, CUTS, LAYERS,
        ],
    ),
    (
        "raycast",
        &[
            LINE, MODE, ONE, LATTICE, FETCHED, HOLES, POINTS, TAPS, SPACE, LAYERS,
        ],
    ),
    (
        "raycast",
        &[
            LINE,
            MODE,
            CHANNELS,
            LATTICE,
            NARROW,
            HOLES,
            TABLE,
            MIXED_LIGHT,
            GRIDS,
            LAYERS,
        ],
    ),
    (
        "raycast",
        &[
            LINE,
            MODE,
            COLORS,
            LATTICE,
            NARROW,
            HOLES,
            TABLE,
            MIXED_LIGHT,
            COLOR_GRIDS,
            LAYERS,
        ],
    ),
    (
        "raycast",
        &[
            LINE,
            MODE,
            CHANNELS,
            LATTICE,
            NARROW_FETCHED,
            HOLES,
            POINTS,
            MIXED_LIGHT,
            GRIDS,
            LAYERS,
        ],
    ),
    (
        "raycast",
        &[
            LINE,
            MODE,
            COLORS,
            LATTICE,
            NARROW_FETCHED,
            HOLES,
            POINTS,
            MIXED_LIGHT,
            COLOR_GRIDS,
            LAYERS,
        ],
    ),
    (
        "raycast",
        &[LINE, MIDA, ONE, RAY, FILTER, HOLES, TABLE, TAPS],
    ),
    (
        "raycast",
        &[LINE, MIDA, ONE, RAY, CORNERS, HOLES, STORED, SHARED, CUTS],
    ),
    (
        "raycast",
        &[LINE, MIDA, ONE, RAY, FETCHED, HOLES, POINTS, TAPS],
    ),
    (
        "isosurface",
        &[slot("color_by", &["level"]), FILTER, HOLES, TAPS],
    ),
    (
        "isosurface",
        &[slot("color_by", &["level"]), CORNERS, HOLES, SHARED, CUTS],
    ),
    (
        "isosurface",
        &[slot("color_by", &["volume"]), NARROW, HOLES, GRIDS, TAPS],
    ),
    (
        "projection_cells",
        &[constant("mode", &["mip", "minip"]), HOLES],
    ),
    (
        "projection",
        &[LINE, PROJECTED, SCALAR, LATTICE, FILTER, HOLES],
    ),
    (
        "projection",
        &[LINE, PROJECTED, SCALAR, LATTICE, CORNERS, HOLES, CUTS],
    ),
    ("raycast", &[LINE, MODE, FIELD, RAY, TRANSFER, LAYERS]),
    (
        "projection",
        &[LINE, constant("mode", &["mip", "minip", "sum"]), FIELD, RAY],
    ),
    // The depth of slices of a stack.
    (
        "raycast",
        &[SLICES, MODE, ONE, STACK, FILTER, HOLES, TABLE, TAPS],
    ),
    (
        "raycast_slab",
        &[SLICE_SLABS, MODE, SLAB, STACK, NARROW, HOLES],
    ),
    (
        "projection",
        &[
            SLICES,
            constant("mode", &["mip", "minip"]),
            SCALAR,
            STACK,
            FILTER,
            HOLES,
        ],
    ),
    (
        "slices_3d",
        &[TESTED, BLEND, ONE, FILTER, HOLES, TRANSFER, TAPS],
    ),
    (
        "slices_3d",
        &[
            TESTED,
            BLEND,
            MIXED,
            NARROW,
            HOLES,
            TRANSFER,
            MIXED_LIGHT,
            GRIDS,
        ],
    ),
    (
        "slices_3d",
        &[
            TESTED, BLEND, ONE, CORNERS, HOLES, STORED, SHARED, PLANES, CUTS,
        ],
    ),
    ("slices_3d", &[NUMBER, SCALAR, END, FILTER, HOLES]),
    (
        "slices_3d",
        &[NUMBER, SCALAR, END, CORNERS, HOLES, PLANES, CUTS],
    ),
    (
        "slices_3d",
        &[TESTED, BLEND, ONE, LINEAR, HOLES, TABLE, TAPS, PLANES, CUTS],
    ),
    (
        "slices_3d",
        &[NUMBER, SCALAR, END, LINEAR, HOLES, PLANES, CUTS],
    ),
    (
        "slices_3d_cover",
        &[slot("parameters", &["uniform", "planes"])],
    ),
    (
        "slices_2d",
        &[TESTED, BLEND, ONE, FILTER, HOLES, TRANSFER, TAPS],
    ),
    (
        "slices_2d",
        &[TESTED, BLEND, MIXED, NARROW, HOLES, TRANSFER, MIXED_LIGHT],
    ),
    ("slices_2d", &[NUMBER, SCALAR, END, FILTER, HOLES]),
    (
        "slices_2d",
        &[
            TESTED, BLEND, ONE, LINEAR, HOLES, TABLE, TAPS, STACKED, CUTS,
        ],
    ),
    (
        "slices_2d",
        &[NUMBER, SCALAR, END, LINEAR, HOLES, STACKED, CUTS],
    ),
    (
        "slices_2d_cover",
        &[slot("parameters", &["uniform", "stack"])],
    ),
    (
        "raycast_slab",
        &[
            SLABS,
            slot("mode", &["composite"]),
            SLAB,
            SLAB_LATTICE,
            NARROW,
            HOLES,
            TAPS,
            LIGHT,
        ],
    ),
    (
        "raycast_slab",
        &[
            SLABS,
            slot("mode", &["composite"]),
            SLAB,
            SLAB_LATTICE,
            CORNERS,
            HOLES,
            STORED,
            SHARED,
            LIGHT,
            TEXEL_PLACE,
            UNHINDERED,
            CUTS,
        ],
    ),
    (
        "slices_3d_slab",
        &[BLEND, SLAB, END, NARROW, HOLES, TAPS, LIGHT],
    ),
    (
        "slices_3d_slab",
        &[
            slot("blend", &["count"]),
            SLAB,
            END,
            slot("filter", &["nearest"]),
            slot("holes", &["none"]),
        ],
    ),
    (
        "slices_2d_slab",
        &[BLEND, SLAB, END, NARROW, HOLES, TAPS, LIGHT, STACK_PLACE],
    ),
    (
        "slices_2d_slab",
        &[
            slot("blend", &["count"]),
            SLAB,
            END,
            slot("filter", &["nearest"]),
            slot("holes", &["none"]),
        ],
    ),
    (
        "slices_2d_smooth",
        &[
            slot("blend", &["composite"]),
            BETWEEN,
            NARROW,
            HOLES,
            TRANSFER,
            TAPS,
            LIGHT,
            STACK_PLACE,
        ],
    ),
    (
        "slices_2d_smooth",
        &[
            slot("blend", &["count"]),
            BETWEEN,
            slot("filter", &["nearest"]),
            slot("holes", &["none"]),
        ],
    ),
    ("slices_3d_half", &[ONE, NARROW, HOLES, TRANSFER, TAPS]),
    (
        "resolve",
        &[slot(
            "source",
            &["picture", "value", "covered", "mean", "cued"],
        )],
    ),
    ("warp", &[slot("source", &["mean", "value"])]),
    ("resolve_cover", &[]),
    (
        "resolve_depth",
        &[constant("output", &["picture", "value"])],
    ),
    ("host_depth_copy", &[]),
    ("path_noise", &[]),
    ("path_noise_sums", &[]),
    ("round_cone_cover", &[]),
    ("round_cone", &[]),
    ("triangle_corner", &[]),
    ("triangle", &[]),
    ("precompute_gradients", &[slot("layout", &["box", "stack"])]),
    ("merge", &[constant("operator", &["over", "under", "add"])]),
    (
        "denoise",
        &[constant(
            "kernel",
            &["gaussian", "median", "bilateral", "nlm"],
        )],
    ),
    // Once for many pictures: classified by the points in all of them.
    (
        "light_cells",
        &[
            slot("layout", &["box", "stack"]),
            constant("filter", &["nearest", "kernel"]),
            HOLES,
            POINTS,
            TAPS,
        ],
    ),
    // Of several volumes: those on grids of their own are interpolated where cells look.
    (
        "light_cells",
        &[
            slot("layout", &["box"]),
            NARROW_FETCHED,
            HOLES,
            POINTS,
            MATTER,
            GRIDS,
        ],
    ),
    (
        "light_cells",
        &[
            slot("layout", &["stack"]),
            slot("filter", &["nearest"]),
            HOLES,
            POINTS,
            MATTER,
        ],
    ),
    ("light_volume", &[]),
    // No picture: the ceiling of the device.
    ("probe", &[]),
    // Which tiles rays draw: all that they may meet something in, or all over the box.
    (
        "ray_tiles",
        &[slot("bounds", &["distances"]), slot("output", &["picture"])],
    ),
    (
        "ray_tiles",
        &[
            slot("bounds", &["box"]),
            constant("output", &["picture", "mida"]),
        ],
    ),
    (
        "ray_tiles",
        &[slot("bounds", &["box"]), slot("output", &["number"])],
    ),
    (
        "ray_tiles",
        &[
            slot("bounds", &["everywhere"]),
            slot("output", &["picture", "number"]),
        ],
    ),
    ("macro_cells", &[slot("layout", &["box", "stack"])]),
    ("distance_map", &[]),
    ("run_words", &[]),
    ("run_blocks", &[]),
    ("run_payload", &[]),
    (
        "slice_patches",
        &[slot("planes", &["view", "stack"]), TOPOLOGY],
    ),
    (
        "slice_patches_cover",
        &[slot("topology", &["triangles", "points"]), PARAMETERS],
    ),
    ("opaque_patches", &[]),
    (
        "splat",
        &[SHEETS, constant("take", &["post", "pre"]), HOLES, TRANSFER],
    ),
    (
        "splat_projection",
        &[SHEETS, constant("mode", &["mip", "minip", "sum"]), HOLES],
    ),
    ("splat_points", &[TRANSFER]),
    (
        "pathtrace",
        &[NARROW, HOLES, TRANSFER, TAPS, FOUND, LEVELS, LAYERS],
    ),
    (
        "pathtrace",
        &[CORNERS, HOLES, STORED, SHARED, FOUND_IN_ONE, LEVELS, LAYERS],
    ),
    (
        "splat_points_projection",
        &[constant("mode", &["mip", "minip", "sum"])],
    ),
];

/// Formats whose storage images every device has (Vulkan specification, required format support), and that shaders may
/// name without a feature.
const STORAGE_FORMATS: &[&str] = &[
    "rgba8unorm",
    "rgba8snorm",
    "rgba8uint",
    "rgba8sint",
    "rgba16uint",
    "rgba16sint",
    "rgba16float",
    "r32uint",
    "r32sint",
    "r32float",
    "rgba32uint",
    "rgba32sint",
    "rgba32float",
];

/// What asks a device and draws nothing: only with the feature `conformance`.
pub const PROBES: &[(&str, &[Slot])] = &[
    (
        "probe/fragment_caster",
        &[SCALAR, slot("holes", &["none"]), TABLE],
    ),
    ("probe/filter_3d", &[]),
    ("probe/filter_array", &[]),
    ("probe/fetch", &[]),
    ("probe/store", &[slot("format", STORAGE_FORMATS)]),
    ("probe/load", &[slot("format", STORAGE_FORMATS)]),
    ("probe/many", &[]),
    ("probe/spots", &[]),
    ("probe/places_3d", &[]),
    ("probe/places_array", &[]),
    ("probe/beyond_read", &[]),
    ("probe/beyond_write", &[]),
    ("probe/beyond_atomic", &[]),
    ("probe/beyond_uniform", &[]),
    ("probe/beyond_fetch", &[]),
    ("probe/beyond_store", &[]),
    ("probe/varyings", &[]),
    ("probe/varied", &[]),
    ("probe/depth", &[]),
    ("probe/relay_draw", &[]),
    ("probe/relay_compute", &[]),
    ("probe/shapes", &[]),
    ("probe/color", &[]),
    ("probe/shared_memory", &[]),
    ("probe/atomics", &[]),
    ("probe/dispatch", &[]),
    ("probe/steps", &[]),
    ("probe/math", &[]),
];
