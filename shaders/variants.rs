//! Which shaders are compiled, and with what: every slot of an `#import` name and the words that fill it. Part of
//! `build.rs`.

/// A slot of `#import` names and the words that fill it.
pub type Slot = (&'static str, &'static [&'static str]);

/// A kernel is wider than linear, by fetches; a spline is a B-spline by the sampler.
const FILTER: Slot = (
    "filter",
    &["nearest", "linear", "linear_fetch", "kernel", "spline"],
);
/// By corners too, of 8-bit and of 16-bit voxels: what rays on their own lattice have on software devices.
const CORNERS: Slot = ("filter", &["corners8", "corners16"]);
/// Conformance pictures search the points, and never leave filtering to the device.
const FETCHED: Slot = ("filter", &["nearest", "linear_fetch", "kernel"]);
/// Several volumes are mixed by narrow filters.
const NARROW: Slot = ("filter", &["nearest", "linear", "linear_fetch"]);
const NARROW_FETCHED: Slot = ("filter", &["nearest", "linear_fetch"]);
const TABLE: Slot = ("transfer", &["table"]);
/// What goes with corners: devices whose sampler is a program.
const STORED: Slot = ("transfer", &["stored"]);
const POINTS: Slot = ("transfer", &["points"]);
/// One number at both ends of a segment. The word is left out of names.
const SLAB: Slot = ("mix", &["slab"]);
/// How central differences are made. The words are left out of names: corners have their own way, and it is theirs alone.
const TAPS: Slot = ("slope", &["taps"]);
const SHARED: Slot = ("slope", &["corners"]);
/// Words that stand in no name.
pub const SILENT: &[&str] = &["alone", "slab", "taps", "corners"];
const TRANSFER: Slot = ("transfer", &["table", "points"]);
const HOLES: Slot = ("holes", &["none", "mask"]);
const LATTICE: Slot = ("lattice", &["ray", "planes"]);
/// One number a voxel, alone or with its gradient. The word `alone` is left out of names.
const ONE: Slot = ("mix", &["alone", "graded"]);
/// Graded for nothing but unhindered light on central differences.
const LIT: Slot = ("mix", &["lit"]);
const ALONE: Slot = ("mix", &["alone"]);
/// Steps that adapt to what is there, of volumes without holes.
const ADAPTIVE: Slot = ("mix", &["adaptive"]);
const WHOLE: Slot = ("holes", &["none"]);
const MIXED: Slot = ("mix", &["channels", "colors"]);
const MODE: Slot = ("mode", &["composite"]);
/// Modes that slicers do not have leave the lattice of slicers to them.
const RAY: Slot = ("lattice", &["ray"]);
const MIDA: Slot = ("mode", &["mida"]);
const BLEND: Slot = ("blend", &["composite"]);

/// The wanted combinations. Order of the slots is the order of words in a variant's name.
pub const ENTRIES: &[(&str, &[Slot])] = &[
    ("raycast", &[MODE, ONE, LATTICE, FILTER, HOLES, TABLE, TAPS]),
    ("raycast", &[MODE, ONE, RAY, CORNERS, HOLES, STORED, SHARED]),
    ("raycast", &[MODE, LIT, RAY, NARROW, HOLES, TABLE, TAPS]),
    ("raycast", &[MODE, LIT, RAY, CORNERS, HOLES, STORED, SHARED]),
    ("raycast", &[MODE, ADAPTIVE, RAY, NARROW, WHOLE, TABLE]),
    ("raycast", &[MODE, ADAPTIVE, RAY, CORNERS, WHOLE, STORED]),
    (
        "raycast",
        &[MODE, ONE, LATTICE, FETCHED, HOLES, POINTS, TAPS],
    ),
    ("raycast", &[MODE, MIXED, LATTICE, NARROW, HOLES, TABLE]),
    (
        "raycast",
        &[MODE, MIXED, LATTICE, NARROW_FETCHED, HOLES, POINTS],
    ),
    ("raycast", &[MIDA, ONE, RAY, FILTER, HOLES, TABLE, TAPS]),
    ("raycast", &[MIDA, ONE, RAY, CORNERS, HOLES, STORED, SHARED]),
    ("raycast", &[MIDA, ONE, RAY, FETCHED, HOLES, POINTS, TAPS]),
    ("isosurface", &[("paint", &["alone"]), FILTER, HOLES, TAPS]),
    (
        "isosurface",
        &[("paint", &["alone"]), CORNERS, HOLES, SHARED],
    ),
    ("isosurface", &[("paint", &["by"]), NARROW, HOLES, TAPS]),
    ("projection_cells", &[("mode", &["mip", "minip"]), HOLES]),
    (
        "projection",
        &[
            ("mode", &["mip", "minip", "sum"]),
            ALONE,
            LATTICE,
            FILTER,
            HOLES,
        ],
    ),
    (
        "projection",
        &[
            ("mode", &["mip", "minip", "sum", "lmip", "attenuated_mip"]),
            ALONE,
            RAY,
            CORNERS,
            HOLES,
        ],
    ),
    (
        "projection",
        &[
            ("mode", &["lmip", "attenuated_mip"]),
            ALONE,
            RAY,
            FILTER,
            HOLES,
        ],
    ),
    ("slices_3d", &[BLEND, ONE, FILTER, HOLES, TABLE, TAPS]),
    ("slices_3d", &[BLEND, ONE, FETCHED, HOLES, POINTS, TAPS]),
    ("slices_3d", &[BLEND, MIXED, NARROW, HOLES, TABLE]),
    ("slices_3d", &[BLEND, MIXED, NARROW_FETCHED, HOLES, POINTS]),
    (
        "slices_3d",
        &[("blend", &["extreme", "sum"]), ALONE, FILTER, HOLES],
    ),
    (
        "slices_3d",
        &[
            ("blend", &["count"]),
            ALONE,
            ("filter", &["nearest"]),
            ("holes", &["none"]),
        ],
    ),
    ("slices_3d_cover", &[]),
    ("slices_2d", &[BLEND, ONE, FILTER, HOLES, TABLE, TAPS]),
    ("slices_2d", &[BLEND, ONE, FETCHED, HOLES, POINTS, TAPS]),
    ("slices_2d", &[BLEND, MIXED, NARROW, HOLES, TABLE]),
    ("slices_2d", &[BLEND, MIXED, NARROW_FETCHED, HOLES, POINTS]),
    (
        "slices_2d",
        &[("blend", &["extreme", "sum"]), ALONE, FILTER, HOLES],
    ),
    (
        "slices_2d",
        &[
            ("blend", &["count"]),
            ALONE,
            ("filter", &["nearest"]),
            ("holes", &["none"]),
        ],
    ),
    ("slices_2d_cover", &[]),
    (
        "raycast_slab",
        &[("mode", &["composite"]), SLAB, LATTICE, NARROW, HOLES],
    ),
    (
        "slices_3d_slab",
        &[("blend", &["composite"]), SLAB, NARROW, HOLES],
    ),
    (
        "slices_3d_slab",
        &[
            ("blend", &["count"]),
            SLAB,
            ("filter", &["nearest"]),
            ("holes", &["none"]),
        ],
    ),
    (
        "slices_2d_slab",
        &[("blend", &["composite"]), SLAB, NARROW, HOLES],
    ),
    (
        "slices_2d_slab",
        &[
            ("blend", &["count"]),
            SLAB,
            ("filter", &["nearest"]),
            ("holes", &["none"]),
        ],
    ),
    (
        "slices_2d_smooth",
        &[("blend", &["composite"]), ALONE, NARROW, HOLES, TRANSFER],
    ),
    (
        "slices_2d_smooth",
        &[
            ("blend", &["count"]),
            ALONE,
            ("filter", &["nearest"]),
            ("holes", &["none"]),
        ],
    ),
    ("slices_3d_half", &[ONE, NARROW, HOLES, TABLE, TAPS]),
    (
        "slices_3d_half",
        &[ONE, NARROW_FETCHED, HOLES, POINTS, TAPS],
    ),
    (
        "resolve",
        &[("source", &["picture", "value", "mean", "cued"])],
    ),
    ("resolve_cover", &[]),
    ("resolve_depth", &[("left", &["picture", "value"])]),
    ("keep_gradients", &[("layout", &["box", "stack"])]),
    ("merge", &[("operator", &["over", "under", "add"])]),
    (
        "denoise",
        &[("kernel", &["gaussian", "median", "bilateral", "nlm"])],
    ),
    // Once for many pictures: classified by the points in all of them.
    (
        "light_cells",
        &[
            ("layout", &["box", "stack"]),
            ("filter", &["nearest", "kernel"]),
            HOLES,
            POINTS,
            TAPS,
        ],
    ),
    ("light_volume", &[]),
    // No picture: the ceiling of the device.
    ("probe", &[]),
    ("macro_cells", &[("layout", &["box", "stack"])]),
    ("distance_map", &[]),
    ("slice_patches", &[("planes", &["view", "stack"])]),
    ("slice_patches_cover", &[]),
    ("opaque_patches", &[]),
];

/// What asks a device and draws nothing: only with the feature `conformance`.
pub const PROBES: &[(&str, &[Slot])] = &[
    ("probe/filter_3d", &[]),
    ("probe/filter_array", &[]),
    ("probe/fetch", &[]),
    (
        "probe/store",
        &[("format", &["rgba32float", "rgba16float"])],
    ),
    ("probe/shapes", &[]),
    ("probe/color", &[]),
    ("probe/shared_memory", &[]),
    ("probe/atomics", &[]),
    ("probe/dispatch", &[]),
    ("probe/steps", &[]),
    ("probe/math", &[]),
];
