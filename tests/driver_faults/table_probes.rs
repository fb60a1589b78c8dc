//! Injected faults of what pictures of this library do not show, and the probe that must see each.

use super::Fault::{self, Shader, State as Changed};
use super::State;
use ash::vk;
use vk::CompareOp;

/// What is wrong, how, and the case that must see it.
pub const PROBE_FAULTS: &[(&str, Fault, &str)] = &[
    (
        "LESS is LESS_OR_EQUAL",
        Changed(State::Compare(CompareOp::LESS, CompareOp::LESS_OR_EQUAL)),
        "probe.depth.compare.less.d16_unorm",
    ),
    (
        "GREATER is LESS",
        Changed(State::Compare(CompareOp::GREATER, CompareOp::LESS)),
        "probe.depth.order.nearest_is_1.d16_unorm",
    ),
    (
        "EQUAL is ALWAYS",
        Changed(State::Compare(CompareOp::EQUAL, CompareOp::ALWAYS)),
        "probe.depth.compare.equal.d32_sfloat",
    ),
    (
        "depth is not written",
        Changed(State::NoDepthWrites),
        "probe.depth.write.d32_sfloat",
    ),
    (
        "depth is not tested",
        Changed(State::NoDepthTest),
        "probe.depth.order.nearest_is_0.d32_sfloat",
    ),
    (
        "the depths of the viewport are forgotten",
        Changed(State::DepthRangeForgotten),
        "probe.depth.plane.reversed.d16_unorm",
    ),
    (
        "what is too near is drawn",
        Changed(State::DepthClamped),
        "probe.depth.cut.d16_unorm",
    ),
    (
        "depth is cleared to something else",
        Changed(State::DepthClearedTo(0.375)),
        "probe.depth.clear.d16_unorm",
    ),
    (
        "depths have fifteen bits",
        Shader(
            "probe/depth.wgsl",
            "depths.d[64u * u32(at.y) + u32(at.x)]",
            "floor(32767.0 * depths.d[64u * u32(at.y) + u32(at.x)]) / 32767.0",
        ),
        "probe.depth.write.d16_unorm",
    ),
    (
        "perspective is forgotten",
        Shader(
            "lib/probe_varyings.wgsl",
            "@interpolate(perspective)",
            "@interpolate(linear)",
        ),
        "probe.interpolate.perspective.0",
    ),
    (
        "there is perspective where none is asked for",
        Shader(
            "lib/probe_varyings.wgsl",
            "@interpolate(linear)",
            "@interpolate(perspective)",
        ),
        "probe.interpolate.linear.0",
    ),
    (
        "what is flat is the second corner's",
        Shader(
            "probe/varyings.wgsl",
            "number, number, number)",
            "number, number, numbers.d[vertex / 3u * 3u + (vertex + 1u) % 3u].x)",
        ),
        "probe.interpolate.flat.0",
    ),
    (
        "pixels have their numbers at their corners",
        Changed(State::Viewport([0.5, 0.5, 0.0, 0.0])),
        "probe.interpolate.inverse_w.0",
    ),
    (
        "buffers are not copied",
        Changed(State::BuffersNotCopied),
        "probe.relay.barriers",
    ),
    (
        "submissions run the last first",
        Changed(State::SubmittedBackwards),
        "probe.relay.submissions",
    ),
    (
        "large counters are ahead of themselves",
        Changed(State::CountersAhead),
        "probe.timeline_semaphore.large_values",
    ),
    (
        "an image in a memory that had another is not written whole",
        Changed(State::LastColumnNotCopied),
        "probe.memory.aliased_images",
    ),
    (
        "a buffer keeps what an image in its place has left",
        Changed(State::FillsWith(0)),
        "probe.memory.image_over_buffer",
    ),
    (
        "shaders read beyond what is bound",
        Changed(State::RangeTimes(2)),
        "probe.robust.buffer.whole.read",
    ),
    (
        "shaders write beyond what is bound",
        Changed(State::RangeTimes(2)),
        "probe.robust.buffer.whole.write",
    ),
    (
        "dynamic offsets are forgotten",
        Changed(State::DynamicOffsetsForgotten),
        "probe.robust.uniform.dynamic_offsets",
    ),
    (
        "texels beyond an image are those of its edge",
        Shader(
            "probe/beyond_fetch.wgsl",
            "textureLoad(probed, place.xyz, 0)",
            "textureLoad(probed, clamp(place.xyz, vec3(0), vec3(7, 5, 4)), 0)",
        ),
        "probe.robust.image.read",
    ),
    (
        "stores beyond an image are stored at its edge",
        Shader(
            "probe/beyond_store.wgsl",
            "places.d[id.x].xy",
            "clamp(places.d[id.x].xy, vec2(0), vec2(7, 5))",
        ),
        "probe.robust.image.write",
    ),
    (
        "places in large buffers have 24 bits",
        Shader(
            "probe/spots.wgsl",
            "large.d[places.d[id.x]] = ~word",
            "large.d[places.d[id.x] & 0xffffffu] = ~word",
        ),
        "probe.limits.storage_buffer",
    ),
    (
        "places in large images have 11 bits",
        Shader(
            "probe/places_3d.wgsl",
            "vec3<i32>(places.d[id.x].xyz)",
            "vec3<i32>(places.d[id.x].xyz & vec3(2047u))",
        ),
        "probe.limits.large_image_3d.depth",
    ),
    (
        "numbers of layers have 10 bits",
        Shader(
            "probe/places_array.wgsl",
            "place.z, 0)",
            "place.z & 1023, 0)",
        ),
        "probe.limits.large_image_2d_array.layers",
    ),
    (
        "a part of many workgroups is not run",
        Changed(State::LastGroupDropped(2)),
        "probe.compute.dispatch.many",
    ),
    (
        "stored codes are cut off and not rounded",
        Shader(
            "probe/store.wgsl",
            "numbers.d[id.y * dims.x + id.x]",
            "trunc(255.0 * numbers.d[id.y * dims.x + id.x]) / 255.0",
        ),
        "probe.store.rgba8_unorm",
    ),
    (
        "signed numbers of 16 bits are stored without their sign",
        Shader(
            "probe/store.wgsl",
            "numbers.d[id.y * dims.x + id.x]",
            "abs(numbers.d[id.y * dims.x + id.x])",
        ),
        "probe.store.rgba16_sint",
    ),
    (
        "channels are loaded in another order",
        Shader(
            "probe/load.wgsl",
            "vec2<i32>(id.xy));",
            "vec2<i32>(id.xy)).zyxw;",
        ),
        "probe.load.rgba8_unorm",
    ),
    (
        "MAX of a single channel adds",
        Changed(State::BlendOp(vk::BlendOp::MAX, vk::BlendOp::ADD)),
        "probe.blend.max.r16_sfloat.instances.8",
    ),
];
