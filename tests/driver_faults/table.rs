//! The injected faults, and the case that must see each.

use super::Fault::{self, Shader, State as Changed};
use super::State;
use ash::vk;
use vk::{BlendFactor as Factor, BlendOp as Op};

const CASTER: &str = "raycast.ray.composite.ramp.linear_fetch.u16.perspective";
const SAMPLED: &str = "raycast.planes.mip.ramp.linear.u16.perspective";
const WARP: &str = "reference.shear_warp.composite.plain.linear_fetch.perspective";
const AXES: &str = "raycast.bresenham.composite.ramp.linear_fetch.u16.perspective";
const FINE: &str = "raycast.bresenham.xray.fine.linear_fetch.f32.perspective";
const PLANES: &str = "slices_3d.over.composite.ramp.linear_fetch.u16.perspective";
const UNDER: &str = "slices_3d.under.composite.ramp.linear_fetch.u16.perspective";
const STACK: &str = "slices_2d.over.composite.ramp.linear_fetch.u16.perspective";

const SHEETS: &str = "splat.image.composite.plain.perspective";
const SLICES: &str = "splat.axis.composite.plain.perspective";
const SUMS: &str = "splat.image.xray.plain.perspective";
const POINTS: &str = "splat.points.composite.cloud.perspective";
const WIDE: &str = "splat.image.composite.wide.perspective";
const CLASSIFIED: &str = "splat.axis.composite.classified.perspective";

/// The precision of a splat of 0.6 voxels that no pixel widens.
const NOT_WIDENED: [&str; 2] = [
    "    let mixed = frame.splat_mixed;
    let turned = frame.splat_diagonal * d + (mixed.zzy * d.yxx + mixed.yxx * d.zzy);
    let along = d.x * turned.x + d.y * turned.y + d.z * turned.z;
    let diagonal = across(k, frame.splat_diagonal).xy;
",
    "    let mixed = vec3(0.0);
    let turned = 2.7777778 * d;
    let along = d.x * turned.x + d.y * turned.y + d.z * turned.z;
    let diagonal = vec2(2.7777778);
",
];

/// What a splat adds to its slice, and the same with opacities in the place of depths.
const OPACITIES: [&str; 2] = [
    "sums += part * (splat_weight(line, square) * numbers_of(voxel));",
    "let more = part * (splat_weight(line, square) * numbers_of(voxel));
            sums += more * select(1.0, (1.0 - exp(-more.w)) / more.w, more.w > 0.0);",
];

/// Where a height meets the ray: by a division, and from the height before it on.
const ADDED_UP: [&str; 2] = [
    "fn height_t(line: MainAxis, k: i32) -> f32 {
    return ((f32(k) + 0.5) / frame.samples_per_voxel - line.height) / line.slope;
",
    "var<private> last_t: f32;
var<private> last_k: i32 = -1000000;

fn height_t(line: MainAxis, k: i32) -> f32 {
    if k == last_k + 1 {
        last_t += height_length(line);
    } else if k != last_k {
        last_t = ((f32(k) + 0.5) / frame.samples_per_voxel - line.height) / line.slope;
    }
    last_k = k;
    return last_t;
",
];

/// What is wrong, how, and the case that must see it.
pub const FAULTS: &[(&str, Fault, &str)] = &[
    (
        "over blends by the target's alpha",
        Changed(State::Factor(
            Factor::ONE_MINUS_SRC_ALPHA,
            Factor::ONE_MINUS_DST_ALPHA,
        )),
        PLANES,
    ),
    (
        "over keeps all of the target",
        Changed(State::Factor(Factor::ONE_MINUS_SRC_ALPHA, Factor::ONE)),
        PLANES,
    ),
    (
        "under blends by the source's alpha",
        Changed(State::Factor(
            Factor::ONE_MINUS_DST_ALPHA,
            Factor::ONE_MINUS_SRC_ALPHA,
        )),
        UNDER,
    ),
    (
        "the source is multiplied by its alpha once more",
        Changed(State::Factor(Factor::ONE, Factor::SRC_ALPHA)),
        PLANES,
    ),
    (
        "alphas forget what was there",
        Changed(State::AlphaFactor(
            Factor::ONE_MINUS_SRC_ALPHA,
            Factor::ZERO,
        )),
        "probe.blend.over.rgba32_sfloat.instances.8",
    ),
    (
        "MAX is MIN",
        Changed(State::BlendOp(Op::MAX, Op::MIN)),
        "slices_3d.mip.ramp.nearest.u16.perspective",
    ),
    (
        "MIN is MAX",
        Changed(State::BlendOp(Op::MIN, Op::MAX)),
        "probe.blend.min.rgba8_unorm.instances.8",
    ),
    (
        "MAX adds",
        Changed(State::BlendOp(Op::MAX, Op::ADD)),
        "probe.blend.max.rgba16_sfloat.triangles.8",
    ),
    (
        "ADD subtracts",
        Changed(State::BlendOp(Op::ADD, Op::REVERSE_SUBTRACT)),
        "probe.blend.add.rgba32_sfloat.instances.64",
    ),
    ("nothing is blended", Changed(State::NoBlending), STACK),
    (
        "alpha is not written",
        Changed(State::ColorsOnly),
        "probe.blend.replace.rgba8_unorm.instances.1",
    ),
    (
        "triangles that go round one way are culled",
        Changed(State::Cull(vk::CullModeFlags::BACK)),
        "probe.raster.cover.*",
    ),
    (
        "triangles that go round the other way are culled",
        Changed(State::Cull(vk::CullModeFlags::FRONT)),
        "probe.raster.cover.*",
    ),
    (
        "the viewport lies a pixel to the right",
        Changed(State::Viewport([1.0, 0.0, 0.0, 0.0])),
        "probe.raster.cover.clockwise",
    ),
    (
        "the viewport is a pixel narrower",
        Changed(State::Viewport([0.0, 0.0, -1.0, 0.0])),
        "probe.raster.shared_edges.0",
    ),
    (
        "y points up",
        Changed(State::UpsideDown),
        "probe.raster.cover.clockwise",
    ),
    (
        "the scissor misses a column",
        Changed(State::ScissorNarrower),
        "probe.raster.shared_edges.0",
    ),
    (
        "the last instance is not drawn",
        Changed(State::LastInstanceDropped),
        "probe.blend.over.rgba32_sfloat.instances.8",
    ),
    (
        "the first instance is not drawn",
        Changed(State::FirstInstanceDropped),
        "probe.blend.add.rgba16_sfloat.instances.8",
    ),
    (
        "the last triangle is not drawn",
        Changed(State::LastTriangleDropped),
        "probe.raster.shared_edges.1",
    ),
    (
        "everything is drawn twice",
        Changed(State::DrawnTwice),
        "probe.raster.shared_edges.2",
    ),
    (
        "the last workgroup along x is not run",
        Changed(State::LastGroupDropped(0)),
        "probe.compute.dispatch.most_along_x",
    ),
    (
        "the last workgroup along y is not run",
        Changed(State::LastGroupDropped(1)),
        "probe.store.rgba32_sfloat",
    ),
    (
        "the last workgroup along z is not run",
        Changed(State::LastGroupDropped(2)),
        "probe.compute.dispatch.most_along_z",
    ),
    (
        "clamp is repeat",
        Changed(State::Address(vk::SamplerAddressMode::REPEAT)),
        "probe.filter.3d.linear.r16_unorm.beyond_edges",
    ),
    (
        "clamp is mirrored repeat",
        Changed(State::Address(vk::SamplerAddressMode::MIRRORED_REPEAT)),
        "probe.filter.3d.linear.r32_sfloat.beyond_edges",
    ),
    (
        "clamp is a border",
        Changed(State::Address(vk::SamplerAddressMode::CLAMP_TO_BORDER)),
        "probe.filter.2d_array.linear.r16_unorm.beyond_edges",
    ),
    (
        "linear is nearest",
        Changed(State::SampledBy(vk::Filter::LINEAR, vk::Filter::NEAREST)),
        SAMPLED,
    ),
    (
        "nearest is linear",
        Changed(State::SampledBy(vk::Filter::NEAREST, vk::Filter::LINEAR)),
        "probe.filter.3d.nearest.r16_unorm.random",
    ),
    (
        "the last column of a texture is not copied",
        Changed(State::LastColumnNotCopied),
        "probe.fetch.r16_unorm.every_code",
    ),
    (
        "the last slice of a texture is not copied",
        Changed(State::LastSliceNotCopied),
        "probe.fetch.r8_unorm.every_code",
    ),
    (
        "pictures come back a texel off",
        Changed(State::ReadbackOneTexelOff),
        CASTER,
    ),
    (
        "targets are cleared to something else",
        Changed(State::ClearedTo(0.25)),
        PLANES,
    ),
    (
        "buffers are filled with something else",
        Changed(State::FillsWith(1)),
        "probe.memory.aliased_buffers",
    ),
    (
        "a timeline is ahead of itself",
        Changed(State::CountersAhead),
        "probe.timeline_semaphore",
    ),
    (
        "a wrong exponent of opacity",
        Shader(
            "lib/opacity.wgsl",
            "1.0 - exp(-depth)",
            "1.0 - exp(-1.01 * depth)",
        ),
        CASTER,
    ),
    (
        "opacity is depth",
        Shader("lib/opacity.wgsl", "1.0 - exp(-depth)", "min(depth, 1.0)"),
        STACK,
    ),
    (
        "the last segment of a ray is dropped",
        Shader("lib/lattice_ray.wgsl", "i32(full) + 1", "i32(full)"),
        CASTER,
    ),
    (
        "the last segment is as long as the others",
        Shader(
            "lib/lattice_ray.wgsl",
            "let length = max(back - front, 0.0);",
            "let length = frame.step_world;",
        ),
        "raycast.ray.composite.homogeneous.linear_fetch.u16.perspective",
    ),
    (
        "samples lie at the front of their segments",
        Shader(
            "lib/lattice_ray.wgsl",
            "(f32(k) + 0.5) * frame.step_world, frame",
            "f32(k) * frame.step_world, frame",
        ),
        CASTER,
    ),
    (
        "samples along a main axis are as long as a step",
        Shader(
            "lib/lattice_bresenham.wgsl",
            "return 1.0 / (frame.samples_per_voxel * line.slope);",
            "return frame.step_world;",
        ),
        AXES,
    ),
    (
        "samples along a main axis are as long in all directions",
        Shader(
            "lib/lattice_bresenham.wgsl",
            "return 1.0 / (frame.samples_per_voxel * line.slope);",
            "return 1.0 / frame.samples_per_voxel;",
        ),
        AXES,
    ),
    (
        "samples along a main axis lie between voxels",
        Shader(
            "lib/lattice_bresenham.wgsl",
            "((f32(k) + 0.5) / frame",
            "(f32(k) / frame",
        ),
        AXES,
    ),
    (
        "the main axis is that of the world",
        Shader(
            "lib/lattice_bresenham.wgsl",
            "abs(voxel.direction)",
            "abs(world.direction)",
        ),
        "raycast.bresenham.xray.flat.linear_fetch.f32.perspective",
    ),
    (
        "samples along a main axis are added up",
        Shader("lib/lattice_bresenham.wgsl", ADDED_UP[0], ADDED_UP[1]),
        "raycast.bresenham.mip.fine.linear_fetch.f32.perspective",
    ),
    (
        "rounding chooses between axes that are alike",
        Shader("lib/main_axis.wgsl", "0.9999847412109375", "1.0"),
        "raycast.bresenham.xray.diagonal.linear_fetch.f32.perspective",
    ),
    (
        "a warp takes the nearest base pixel",
        Shader(
            "warp.wgsl",
            "let part = middles - low;",
            "let part = round(middles - low);",
        ),
        WARP,
    ),
    (
        "a warp mixes in the wrong order",
        Shader(
            "warp.wgsl",
            "vec2<i32>(low) + vec2(1, 0)",
            "vec2<i32>(low) + vec2(0, 1)",
        ),
        WARP,
    ),
    (
        "a warp is as if all base pixels were as near",
        Shader("warp.wgsl", "place.xy / place.z", "place.xy"),
        WARP,
    ),
    (
        "a warp of maxima counts rays without a value",
        Shader("lib/warp_value.wgsl", "sum.x / sum.y", "sum.x"),
        "reference.shear_warp.mip.plain.linear_fetch.perspective",
    ),
    (
        "the last point of a list is left out",
        Shader(
            "splat_points.wgsl",
            "i < list.y && !is_finished",
            "i + 1u < list.y && !is_finished",
        ),
        POINTS,
    ),
    (
        "points come from back to front",
        Shader(
            "splat_points.wgsl",
            "let point = listed(i);",
            "let point = listed(list.x + list.y - 1u - i);",
        ),
        POINTS,
    ),
    (
        "points are thinner by the square root of two",
        Shader(
            "splat_points.wgsl",
            "exp(-0.5 * square)",
            "exp(-1.0 * square)",
        ),
        POINTS,
    ),
    (
        "points end nearer to their centres",
        Shader(
            "splat_points.wgsl",
            "square > frame.splat_reach * frame.splat_reach",
            "square > frame.splat_reach",
        ),
        POINTS,
    ),
    (
        "points behind the eye are seen",
        Shader(
            "lib/view_points.wgsl",
            "select(1e30, dot(off, off), t > 0.0)",
            "dot(off, off)",
        ),
        "splat.points.xray.among.perspective",
    ),
    (
        "extremes of points count as far as their sums",
        Shader(
            "splat_points_projection.wgsl",
            "const EXTREME_SQUARE: f32 = 4.0;",
            "const EXTREME_SQUARE: f32 = 9.0;",
        ),
        "splat.points.mip.cloud.perspective",
    ),
    (
        "sums of points take how much matter they are, not how much a ray meets",
        Shader(
            "splat_points_projection.wgsl",
            "view_points.all[point].density * exp",
            "view_points.all[point].length * exp",
        ),
        "splat.points.xray.small.perspective",
    ),
    (
        "splats are as narrow as if pixels were narrow",
        Shader("lib/splat_line.wgsl", NOT_WIDENED[0], NOT_WIDENED[1]),
        WIDE,
    ),
    (
        "splats that pixels widen are wide along the axes alone",
        Shader(
            "lib/splat_line.wgsl",
            "let mixed = frame.splat_mixed;",
            "let mixed = vec3(0.0);",
        ),
        WIDE,
    ),
    (
        "splats that pixels widen are as high as narrow ones",
        Shader(
            "lib/splat_line.wgsl",
            "frame.splat_peak / kappa",
            "0.7368284 / kappa",
        ),
        "splat.image.xray.wide.perspective",
    ),
    (
        "splats are as high whatever way they are seen",
        Shader(
            "lib/splat_line.wgsl",
            "frame.splat_peak / kappa",
            "frame.splat_peak",
        ),
        SUMS,
    ),
    (
        "splats are looked for too near the ray",
        Shader(
            "lib/splat_line.wgsl",
            "let cut = frame.splat_reach;",
            "let cut = 0.6 * frame.splat_reach;",
        ),
        SUMS,
    ),
    (
        "the last column and row near the ray are left out",
        Shader(
            "lib/splat_line.wgsl",
            "max(last - first + 1, vec2(0))",
            "max(last - first, vec2(0))",
        ),
        SUMS,
    ),
    (
        "slices of splats come from back to front",
        Shader(
            "lib/splat_line.wgsl",
            "SplatSlices(select(last, first, is_up), select(-1, 1, is_up), ",
            "SplatSlices(select(first, last, is_up), select(1, -1, is_up), ",
        ),
        SLICES,
    ),
    (
        "splats are cut as if they were densest before their slice",
        Shader(
            "lib/splat_image.wgsl",
            "line.kappa * dot(line.drift, w)",
            "-line.kappa * dot(line.drift, w)",
        ),
        SHEETS,
    ),
    (
        "splats are cut as if they were densest in their slice",
        Shader(
            "lib/splat_image.wgsl",
            "line.kappa * dot(line.drift, w)",
            "0.0",
        ),
        SHEETS,
    ),
    (
        "splats are cut by sheets that lie a half of one off",
        Shader(
            "lib/splat_image.wgsl",
            "vec4(0.0, 1.0, 2.0, 3.0)",
            "vec4(0.5, 1.5, 2.5, 3.5)",
        ),
        SHEETS,
    ),
    (
        "sheets have all of a splat before their ends",
        Shader(
            "lib/splat_image.wgsl",
            "upper - vec4(lower, upper.xyz)",
            "upper",
        ),
        SHEETS,
    ),
    (
        "sheets are closed before all slices are in them",
        Shader("lib/splat_image.wgsl", " - SLACK;", " + 1.0;"),
        SHEETS,
    ),
    (
        "the fifth open sheet is the fourth",
        Shader(
            "lib/splat_image.wgsl",
            "open[4] += part.x * numbers;",
            "open[3] += part.x * numbers;",
        ),
        "splat.image.composite.*.perspective",
    ),
    (
        "the normal distribution is another",
        Shader("lib/normal.wgsl", "0.231641888", "0.24"),
        SHEETS,
    ),
    (
        "voxels without data are zeros to splats",
        Shader(
            "lib/splat_voxel.wgsl",
            "vec4(0.0, 0.0, 1.0, 0.0)",
            "vec4(0.0, 1.0, 1.0, 0.0)",
        ),
        "splat.image.composite.holes.perspective",
    ),
    (
        "slices of splats have length one",
        Shader("lib/splat_axis.wgsl", "1.0 / abs(line.direction.z)", "1.0"),
        SLICES,
    ),
    (
        "classified splats add opacities",
        Shader("lib/splat_axis.wgsl", OPACITIES[0], OPACITIES[1]),
        CLASSIFIED,
    ),
    (
        "a sheet of classified splats has the light of all of them",
        Shader("lib/splat_pre.wgsl", "sums.xyz / sums.w", "sums.xyz"),
        CLASSIFIED,
    ),
    (
        "rows and columns of splats come from back to front",
        Shader(
            "lib/splat_each.wgsl",
            "line.direction.xy < vec2(0.0)",
            "line.direction.xy > vec2(0.0)",
        ),
        "splat.none.composite.classified.perspective",
    ),
    (
        "sheets are compared where they begin",
        Shader(
            "lib/splat_value.wgsl",
            "range.t.x <= edges.z && edges.z < range.t.y",
            "range.t.x <= edges.x && edges.x < range.t.y",
        ),
        "splat.image.mip.plain.perspective",
    ),
    (
        "slices lie half their distance off",
        Shader(
            "lib/ray.wgsl",
            " - frame.plane_offset",
            " - frame.plane_offset - 0.5 * frame.step_world",
        ),
        WARP,
    ),
    (
        "more samples a voxel are shorter and not nearer",
        Shader(
            "lib/lattice_bresenham.wgsl",
            "((f32(k) + 0.5) / frame.samples_per_voxel - line.height)",
            "(f32(k) + 0.5 - line.height)",
        ),
        FINE,
    ),
    (
        "a sample where the ray enters is left out",
        Shader(
            "lib/lattice_bresenham.wgsl",
            "lattice.t0 <= t",
            "lattice.t0 < t",
        ),
        "raycast.bresenham.composite.on_faces.forwards",
    ),
    (
        "planes lie half a step off",
        Shader(
            "lib/ray.wgsl",
            "((f32(k) + 0.5) * frame.step_world - plane",
            "(f32(k) * frame.step_world - plane",
        ),
        PLANES,
    ),
    (
        "slices are as long at the edge of the picture as in the middle",
        Shader(
            "lib/ray.wgsl",
            "return frame.step_world / dot(frame.forward, world.direction);",
            "return frame.step_world;",
        ),
        PLANES,
    ),
    (
        "stacks have samples of length one",
        Shader("slices_2d.wgsl", "1.0 / abs(slope)", "1.0"),
        STACK,
    ),
    (
        "directions are not of length one",
        Shader(
            "lib/ray.wgsl",
            "direction_of(frame.direction + place.x * frame.direction_dx + place.y * frame.direction_dy)",
            "frame.direction + place.x * frame.direction_dx + place.y * frame.direction_dy",
        ),
        CASTER,
    ),
    (
        "one face of the box is not seen",
        Shader("lib/ray.wgsl", "leave.y), leave.z)", "leave.y), leave.x)"),
        "raycast.ray.composite.homogeneous.linear_fetch.u16.orthographic",
    ),
    (
        "fetches are weighed half a texel off",
        Shader(
            "lib/filter_linear_fetch.wgsl",
            "fract(voxel - 0.5)",
            "fract(voxel)",
        ),
        CASTER,
    ),
    (
        "the sampler is asked half a texel off",
        Shader(
            "lib/filter_linear.wgsl",
            "(voxel - frame.brick_origin)",
            "(voxel + 0.5 - frame.brick_origin)",
        ),
        SAMPLED,
    ),
    (
        "axes of the sampler are swapped",
        Shader(
            "lib/filter_linear.wgsl",
            "volume_sampler, texture, 0.0",
            "volume_sampler, texture.yxz, 0.0",
        ),
        SAMPLED,
    ),
    (
        "axes inside of a slice are swapped",
        Shader(
            "lib/stack_linear_fetch.wgsl",
            "fract(in_stack(place.voxel).xy - 0.5)",
            "fract(in_stack(place.voxel).yx - 0.5)",
        ),
        STACK,
    ),
    (
        "codes are cut off and not rounded",
        Shader("lib/value.wgsl", "round(code)", "floor(code)"),
        "raycast.ray.mip.ramp.nearest.u16.*|raycast.ray.mip.ramp.nearest.u8.*",
    ),
    (
        "signed codes keep their offset",
        Shader(
            "lib/value.wgsl",
            "coding.is_integer != 0u) + coding.offset",
            "coding.is_integer != 0u)",
        ),
        "raycast.ray.mip.ramp.nearest.i16.orthographic",
    ),
    (
        "the intercept is forgotten",
        Shader(
            "lib/value.wgsl",
            "code * coding.slope + coding.intercept",
            "code * coding.slope",
        ),
        "raycast.ray.xray.ramp.nearest.f32.perspective",
    ),
    (
        "the nearest voxel is the next one",
        Shader("lib/nearest.wgsl", "floor(voxel)", "round(voxel)"),
        "raycast.ray.mip.ramp.nearest.f32.perspective",
    ),
    (
        "the maximum is the minimum",
        Shader(
            "lib/mode_mip.wgsl",
            "value > so_far.value",
            "value < so_far.value",
        ),
        "raycast.ray.mip.ramp.linear_fetch.f32.perspective",
    ),
    (
        "sums do not count lengths",
        Shader(
            "lib/mode_sum.wgsl",
            "so_far.value + value * segment.length",
            "so_far.value + value",
        ),
        "raycast.ray.xray.ramp.linear_fetch.f32.perspective",
    ),
    (
        "slices sum up without lengths",
        Shader(
            "lib/blend_number.wgsl",
            "sample * length_world, length_world",
            "sample, length_world",
        ),
        "slices_3d.xray.ramp.linear_fetch.f32.perspective",
    ),
    (
        "a mean is a sum",
        Shader("lib/resolve_mean.wgsl", "found.x / found.y", "found.x"),
        "raycast.ray.average.ramp.linear_fetch.f32.perspective",
    ),
    (
        "the reference length is forgotten",
        Shader("lib/extinction.wgsl", ") / reference_length", ")"),
        "reference.raycast.ray.composite.plain.linear_fetch.perspective",
    ),
    (
        "colours are decoded by 2.2",
        Shader("lib/color.wgsl", "vec3(2.4)", "vec3(2.2)"),
        "reference.raycast.ray.mip.plain.linear_fetch.perspective",
    ),
    (
        "functions are steps",
        Shader("lib/points.wgsl", "left + part * (right - left)", "left"),
        CASTER,
    ),
    (
        "colours are not multiplied by opacity",
        Shader(
            "lib/mode_composite.wgsl",
            "so_far.transmittance * opacity * material.color",
            "so_far.transmittance * material.color",
        ),
        CASTER,
    ),
    (
        "over for under in a ray",
        Shader(
            "lib/mode_composite.wgsl",
            "next.color += so_far.transmittance * opacity * material.color",
            "next.color = (1.0 - opacity) * so_far.color + opacity * material.color",
        ),
        CASTER,
    ),
    (
        "rays end when half of the light is gone",
        Shader(
            "lib/mode_composite.wgsl",
            "so_far.transmittance < frame.termination",
            "so_far.transmittance < 0.5",
        ),
        CASTER,
    ),
    (
        "holes are seen",
        Shader(
            "lib/holes_mask.wgsl",
            "|| all_valid(validity, footprint)",
            "|| true",
        ),
        "reference.raycast.ray.composite.holes.linear_fetch.perspective",
    ),
    (
        "the specular light is too wide",
        Shader(
            "lib/shade.wgsl",
            "pow(min(facing, 1.0), frame.shininess)",
            "pow(min(facing, 1.0), 0.9 * frame.shininess)",
        ),
        "reference.raycast.ray.composite.lit.linear_fetch.perspective",
    ),
    (
        "a wrong weight of the cubic",
        Shader(
            "lib/kernel.wgsl",
            "2.0 / 3.0 - 0.5 * f * f",
            "2.0 / 3.0 - 0.49 * f * f",
        ),
        "reference.raycast.ray.mip.plain.cubic.perspective",
    ),
    (
        "weights of three bits",
        Shader(
            "probe/filter_3d.wgsl",
            "places.d[id.x].xyz",
            "floor(32.0 * places.d[id.x].xyz) / 32.0",
        ),
        "probe.filter.3d.linear.r16_unorm.along_x",
    ),
    (
        "weights of six bits that are said to be more",
        Shader(
            "probe/filter_array.wgsl",
            "place.xy,",
            "floor(256.0 * place.xy) / 256.0,",
        ),
        "probe.filter.2d_array.linear.r16_unorm.along_y",
    ),
    (
        "layers of a stack are one off",
        Shader(
            "probe/filter_array.wgsl",
            "i32(place.z)",
            "i32(place.z) + 1",
        ),
        "probe.filter.2d_array.linear.r16_unorm.centers",
    ),
    (
        "a barrier in a workgroup is missing",
        Shader(
            "probe/shared_memory.wgsl",
            "        workgroupBarrier();\n        sum += other;",
            "        sum += other;",
        ),
        "probe.compute.shared_memory",
    ),
    (
        "both barriers of a step are missing",
        Shader(
            "probe/shared_memory.wgsl",
            "        workgroupBarrier();\n",
            "",
        ),
        "probe.compute.shared_memory",
    ),
    (
        "an atomic is none",
        Shader(
            "probe/atomics.wgsl",
            "atomicAdd(&together.next, 1u)",
            "atomicLoad(&together.next); atomicStore(&together.next, tickets.d[id.x] + 1u)",
        ),
        "probe.compute.atomics",
    ),
    (
        "an atomic maximum adds",
        Shader("probe/atomics.wgsl", "atomicMax(", "atomicAdd("),
        "probe.compute.atomics",
    ),
    (
        "exp is 2^x",
        Shader("probe/math.wgsl", "exp(-x)", "exp2(-x)"),
        "probe.math.exp",
    ),
    (
        "sqrt has eleven bits",
        Shader(
            "probe/math.wgsl",
            "sqrt(x), inverse",
            "bitcast<f32>(bitcast<u32>(sqrt(x)) & 0xfffff000u), inverse",
        ),
        "probe.math.sqrt",
    ),
    (
        "floats are stored as halves",
        Shader(
            "probe/store.wgsl",
            "numbers.d[id.y * dims.x + id.x]",
            "bitcast<vec4<f32>>(bitcast<vec4<u32>>(numbers.d[id.y * dims.x + id.x]) & vec4(0xffffe000u))",
        ),
        "probe.store.rgba32_sfloat",
    ),
];

/// The same on a device of the least limits, which blends slices in 16-bit floats.
pub const CLAMPED_FAULTS: &[(&str, Fault, &str)] = &[
    (
        "a batch does not hide those behind it",
        Shader("lib/merge_over.wgsl", "(1.0 - batch.w) * before", "before"),
        "slices_3d.over.composite.homogeneous.linear_fetch.u16.perspective",
    ),
    (
        "a batch is not hidden by those before it",
        Shader("lib/merge_under.wgsl", "(1.0 - before.w) * batch", "batch"),
        "slices_3d.under.composite.homogeneous.linear_fetch.u16.perspective",
    ),
    (
        "over keeps all of the target",
        Changed(State::Factor(Factor::ONE_MINUS_SRC_ALPHA, Factor::ONE)),
        PLANES,
    ),
    (
        "under blends by the source's alpha",
        Changed(State::Factor(
            Factor::ONE_MINUS_DST_ALPHA,
            Factor::ONE_MINUS_SRC_ALPHA,
        )),
        UNDER,
    ),
    ("nothing is blended", Changed(State::NoBlending), STACK),
    (
        "matter is a tenth denser",
        Shader(
            "lib/opacity.wgsl",
            "1.0 - exp(-depth)",
            "1.0 - exp(-1.1 * depth)",
        ),
        STACK,
    ),
    (
        "stacks have samples of length one",
        Shader("slices_2d.wgsl", "1.0 / abs(slope)", "1.0"),
        STACK,
    ),
];
