//! Injected faults of light that scatters, along rays and random paths, and the case that must see each.

use super::Fault::{self, Shader};

const TWO_LOBES: &str = "reference.pathtrace.composite.two_lobes.linear_fetch.perspective";
const ISOTROPIC: &str = "reference.pathtrace.composite.isotropic.linear_fetch.perspective";
const ONCE: &str = "reference.pathtrace.composite.rayleigh_once.linear_fetch.perspective";
const NO_BOUNCE: &str = "reference.pathtrace.composite.no_bounce.linear_fetch.perspective";
const SKY: &str = "reference.pathtrace.composite.sky.linear_fetch.perspective";
const LAMPS: &str = "reference.pathtrace.composite.lamps.linear_fetch.perspective";
const MEDIUM: &str = "reference.pathtrace.composite.medium.linear_fetch.perspective";
const CUT: &str = "reference.pathtrace.composite.cut.linear_fetch.perspective";
const STEEP: &str = "reference.pathtrace.composite.steep.linear_fetch.perspective";
const DEEP: &str = "pathtrace.composite.deep.linear_fetch.f32.perspective";
const PLANE: &str = "pathtrace.composite.plane.linear_fetch.f32.perspective";
const CELLS: &str = "pathtrace.composite.cells.linear_fetch.f32.orthographic";
const OPEN: &str = "reference.raycast.ray.composite.scattered_open.linear_fetch.perspective";
const MARCH: &str = "reference.raycast.ray.composite.scattered_march.linear_fetch.perspective";
const POINT: &str = "reference.raycast.ray.composite.scattered_point.linear_fetch.perspective";

/// A surface that a way enters and leaves in one cell is not met (`tests/exact/pathtrace/isosurfaces.rs`).
pub const GRAZING_FAULT: Fault = Shader(
    "lib/crossing_levels.wgsl",
    "clamp(extremes(cubic), vec2(0.0), vec2(length))",
    "vec2(0.0)",
);

/// Majorants of a cell leave out the voxels around it: where the device makes them (`tests/exact/macro_cells.rs`).
pub const HALO_FAULT: Fault = Shader(
    "macro_cells.wgsl",
    "let halo = vec3(cell_grid.halo);",
    "let halo = vec3(0);",
);

/// Where less than a tenth of a light comes through, none does (`tests/exact/pathtrace/trackers.rs`).
pub const DARK_FAULT: Fault = Shader(
    "pathtrace.wgsl",
    "select(0.0, LEAST / most, u.y * LEAST < most)",
    "0.0",
);

/// What is wrong, how, and the case that must see it.
pub const SCATTER_FAULTS: &[(&str, Fault, &str)] = &[
    (
        "a phase function is 1 / pi of all directions",
        Shader("lib/phase.wgsl", "(12.566371 * d", "(3.1415927 * d"),
        TWO_LOBES,
    ),
    (
        "a light before the eye is scattered back",
        Shader(
            "lib/phase.wgsl",
            "2.0 * g * (1.0 - c)",
            "2.0 * g * (1.0 + c)",
        ),
        OPEN,
    ),
    (
        "surfaces reflect as much from whatever side light comes",
        Shader(
            "lib/surface.wgsl",
            "return vec3(max(light, 0.0));",
            "return vec3(f32(light > 0.0));",
        ),
        PLANE,
    ),
    (
        "majorants are those of the least value of a cell",
        Shader(
            "lib/majorants.wgsl",
            "clamp(bins, vec2(0.0), vec2(last))",
            "clamp(bins, vec2(0.0), vec2(last)).xx",
        ),
        CELLS,
    ),
    (
        "what three extinctions let through is not divided by its chance",
        Shader(
            "pathtrace.wgsl",
            "of_colors(1.0 - chances, 1.0 - chance)",
            "of_colors(1.0 - chances, 1.0)",
        ),
        MEDIUM,
    ),
    (
        "paths that roulette keeps weigh no more than before",
        Shader(
            "pathtrace.wgsl",
            "return select(0.0, 1.0 / part, u < part);",
            "return select(0.0, 1.0, u < part);",
        ),
        ISOTROPIC,
    ),
    (
        "a sky that is found in two ways counts twice",
        Shader(
            "pathtrace.wgsl",
            "of_sky.radiance * path.density / (path.density + of_sky.density / f32(light_kinds()))",
            "of_sky.radiance",
        ),
        SKY,
    ),
    (
        "what is in the way of light counts twice",
        Shader(
            "pathtrace.wgsl",
            "path.weight * at.light * at.through;",
            "path.weight * at.light * at.through * at.through;",
        ),
        ONCE,
    ),
    (
        "ways through voxels are as long as through cubes of length one",
        Shader(
            "pathtrace.wgsl",
            "let place = walk.voxel.origin + walk.t * walk.voxel.direction;",
            "let place = walk.voxel.origin + walk.t * direction_of(walk.voxel.direction);",
        ),
        NO_BOUNCE,
    ),
    (
        "light of a ball begins behind it",
        Shader("lib/lamp.wgsl", "select(-chord, chord, is_inside)", "chord"),
        LAMPS,
    ),
    (
        "the last piece of a way to a light is dropped",
        Shader(
            "lib/light_ray.wgsl",
            "(k <= ray.whole) & has_data(place)",
            "(k < ray.whole) & has_data(place)",
        ),
        MARCH,
    ),
    (
        "a step has the light of a point that comes to its middle",
        Shader(
            "lib/point_light.wgsl",
            "return 6.2831855 * turn_of(vec2(d * d + product, d * h)) / (d * h);",
            "return 1.0 / dot(to_light, to_light);",
        ),
        POINT,
    ),
    (
        "light is scattered 64 times at most",
        Shader(
            "pathtrace.wgsl",
            "path.bounces == frame.path_bounces;",
            "path.bounces == min(frame.path_bounces, 64u);",
        ),
        DEEP,
    ),
    (
        "directions to a sky are as dense at its poles as between them",
        Shader(
            "lib/sky.wgsl",
            "let z = above + numbers.z * (below - above);",
            "let z = turned(0.5 * (row + numbers.z) / f32(size.y)).x;",
        ),
        SKY,
    ),
    (
        "the number of a path stands in the place of that of its pixel",
        Shader("pathtrace.wgsl", "key.y = sample;", "key.x = sample;"),
        ISOTROPIC,
    ),
    (
        "random numbers reach beyond 1",
        Shader(
            "lib/random.wgsl",
            "* (1.0 / 16777216.0)",
            "* (1.0 / 16700000.0)",
        ),
        ISOTROPIC,
    ),
    (
        "random numbers are rounded up, and reach 1",
        Shader(
            "lib/random.wgsl",
            "return vec4<f32>(pcg4d(key) >> vec4(8u)) * (1.0 / 16777216.0);",
            "return ceil(vec4<f32>(pcg4d(key) >> vec4(8u)) * (1.0 / 65536.0)) * (1.0 / 256.0);",
        ),
        ISOTROPIC,
    ),
    (
        "a direction number of Sobol's second dimension is another",
        Shader(
            "lib/sobol.wgsl",
            "y ^= (y >> 2u) & 0x33333333u;",
            "y ^= (y >> 2u) & 0x33333332u;",
        ),
        ISOTROPIC,
    ),
    (
        "all pixels have the points of one",
        Shader("lib/sobol.wgsl", "pcg4d(vec4(key.x,", "pcg4d(vec4(0u,"),
        ISOTROPIC,
    ),
    (
        "both halves of the paths have the same points",
        Shader("lib/sobol.wgsl", "(2u * pair + half)", "(2u * pair)"),
        ISOTROPIC,
    ),
    (
        "extinctions are those of a voxel, not of a length",
        Shader(
            "pathtrace.wgsl",
            "matter.extinctions * frame.path_density",
            "matter.extinctions * frame.path_density / frame.smallest_spacing",
        ),
        NO_BOUNCE,
    ),
    (
        "no light comes through what is cut away",
        Shader(
            "pathtrace.wgsl",
            "walk.end = min(walk.end, at.reach);",
            "walk.end = min(walk.end, at.reach); if frame.clip_plane_count != 0u { at.light = vec3(0.0); }",
        ),
        CUT,
    ),
    (
        "gradients say nothing of how opaque matter is to paths",
        Shader(
            "lib/matter_by_gradient.wgsl",
            "norm(gradient), second)",
            "0.0, second)",
        ),
        STEEP,
    ),
];
