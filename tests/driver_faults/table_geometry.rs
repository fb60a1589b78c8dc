//! Injected faults of opaque geometry and of the volume that ends at it: tests of pictures in closed form must see each.

use super::Fault::{self, Shader};

/// Where a ray meets a round cone.
pub const CONE_FAULTS: &[(&str, Fault)] = &[
    (
        "the origin of a ray stays at the eye",
        Shader(
            "lib/round_cone.wgsl",
            "    let start = to_middle + moved;
    let v = moved * d - beside - from_middle;
",
            "    let start = 0.0;
    let v = ray.origin - middle - from_middle;
",
        ),
    ),
    (
        "each end has the radius of the other",
        Shader(
            "round_cone.wgsl",
            "met_cone(ray, first, second)",
            "met_cone(ray, vec4(first.xyz, second.w), vec4(second.xyz, first.w))",
        ),
    ),
    (
        "a side is met where the ray leaves it",
        Shader(
            "lib/round_cone.wgsl",
            "let t = (-sqrt(h) - k1) / k2;",
            "let t = (sqrt(h) - k1) / k2;",
        ),
    ),
    (
        "an end is met where the ray leaves it",
        Shader(
            "lib/round_cone.wgsl",
            "let t = -m - sqrt(h);",
            "let t = sqrt(h) - m;",
        ),
    ),
    (
        "cones have the normals of cylinders",
        Shader(
            "lib/round_cone.wgsl",
            "direction_of(d2 * (v + t * d) - y * u)",
            "direction_of(uu * (v + t * d) - (uv + t * ud) * u)",
        ),
    ),
    (
        "colours are those of the first end",
        Shader(
            "round_cone.wgsl",
            "first_color + hit.part * (second_color - first_color)",
            "first_color",
        ),
    ),
];

/// Where a ray ends before geometry.
pub const END_FAULTS: &[(&str, Fault)] = &[
    (
        "rays go on behind geometry",
        Shader(
            "lib/host_depth.wgsl",
            "min(interval.y, distance_at(world, drawn))",
            "interval.y",
        ),
    ),
    (
        "the last step before geometry is a whole one",
        Shader(
            "lib/lattice_ray.wgsl",
            "let back = select(lattice.start + f32(k + 1) * frame.step_world, lattice.t1, is_last);",
            "let back = lattice.start + f32(k + 1) * frame.step_world;",
        ),
    ),
    (
        "the last step before geometry is left out",
        Shader(
            "lib/lattice_ray.wgsl",
            "i32(full) + 1, interval.x",
            "i32(full), interval.x",
        ),
    ),
];
