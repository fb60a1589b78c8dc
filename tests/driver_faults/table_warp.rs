//! Injected faults of shear-warp, beside those of `table.rs`: of the lengths of base rays, and of what a warp is a mean of.

use super::Fault::{self, Shader};

const WARP: &str = "reference.shear_warp.composite.plain.linear_fetch.perspective";

/// A mean of premultiplied colours.
const MEAN: &str = "    return WarpSum(so_far.sum + weight * texel);
}

fn warp_end(found: WarpSum) -> vec4<f32> {
    return found.sum;";

/// What is wrong, how, and the case that must see it.
pub const WARP_FAULTS: &[(&str, Fault, &str)] = &[
    (
        "a warp is a mean of straight colours",
        Shader(
            "lib/warp_mean.wgsl",
            MEAN,
            "    return WarpSum(so_far.sum + weight * vec4(texel.xyz / max(texel.w, 1e-6), texel.w));
}

fn warp_end(found: WarpSum) -> vec4<f32> {
    return vec4(found.sum.xyz * found.sum.w, found.sum.w);",
        ),
        WARP,
    ),
    (
        "a warp is a mean of encoded colours",
        Shader(
            "lib/warp_mean.wgsl",
            MEAN,
            "    return WarpSum(so_far.sum + weight * vec4(pow(texel.xyz, vec3(1.0 / 2.2)), texel.w));
}

fn warp_end(found: WarpSum) -> vec4<f32> {
    return vec4(pow(found.sum.xyz, vec3(2.2)), found.sum.w);",
        ),
        WARP,
    ),
    (
        "samples of all base rays are as long as those of the middle one",
        Shader(
            "lib/ray.wgsl",
            "return frame.step_world / dot(frame.forward, world.direction);",
            "let half = 0.5 * vec2<f32>(frame.extent_pixels);
    let middle = frame.direction + half.x * frame.direction_dx + half.y * frame.direction_dy;
    return frame.step_world / dot(frame.forward, direction_of(middle));",
        ),
        WARP,
    ),
    (
        "samples of base rays are as short as base pixels",
        Shader(
            "lib/ray.wgsl",
            "return frame.step_world / dot(frame.forward, world.direction);",
            "return 0.5 * frame.step_world / dot(frame.forward, world.direction);",
        ),
        "reference.shear_warp.composite.fine.linear_fetch.perspective",
    ),
    (
        "the last base pixel of a row is left out",
        Shader(
            "warp.wgsl",
            "any(at >= vec2<i32>(frame.extent_pixels))",
            "any(at >= vec2<i32>(frame.extent_pixels) - vec2(4, 0))",
        ),
        "reference.shear_warp.composite.along_axis.linear_fetch.orthographic",
    ),
];
