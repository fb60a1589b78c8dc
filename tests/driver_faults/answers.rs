//! More injected faults: of modes along rays, surfaces, slabs, light, mixtures and cuts, and the case that must see each.

use super::Fault::{self, Shader};

/// What is wrong, how, and the case that must see it.
pub const ANSWERS: &[(&str, Fault, &str)] = &[
    (
        "the first local maximum is the last sample over the threshold",
        Shader(
            "lib/mode_lmip.wgsl",
            "so_far.weight == 0.0 || value > so_far.value",
            "so_far.weight == 0.0 || value > min(so_far.value, frame.lmip_threshold)",
        ),
        "raycast.ray.lmip.waves.linear_fetch.f32.perspective",
    ),
    (
        "what lies before a value fades it by its count and not by its length",
        Shader(
            "lib/mode_attenuated_mip.wgsl",
            "before + unit * segment.length",
            "before + unit",
        ),
        "raycast.ray.attenuated_mip.waves.linear_fetch.f32.perspective",
    ),
    (
        "a new maximum takes from colours alone",
        Shader(
            "lib/mode_mida.wgsl",
            "let transmittance = so_far.transmittance + taken * (1.0 - so_far.transmittance);",
            "let transmittance = so_far.transmittance;",
        ),
        "raycast.ray.mida.waves.linear_fetch.f32.perspective",
    ),
    (
        "surfaces are met a hundredth too soon",
        Shader(
            "isosurface.wgsl",
            "let t = crossing(bracket, level);",
            "let t = crossing(bracket, level) - 0.01;",
        ),
        "raycast.ray.iso.plane.linear_fetch.f32.orthographic",
    ),
    (
        "surfaces lie where segments end",
        Shader(
            "isosurface.wgsl",
            "let t = crossing(bracket, level);",
            "let t = far.t;",
        ),
        "raycast.ray.iso.ball.linear_fetch.f32.*",
    ),
    (
        "a slab has the mean of its upper half",
        Shader(
            "lib/transfer_slabs.wgsl",
            "let low = slab_position(min(front, back));",
            "let low = slab_position(0.5 * (front + back));",
        ),
        "raycast.ray.composite.slabs_spike.linear_fetch.f32.perspective",
    ),
    (
        "whole cells of the table are counted from the first",
        Shader(
            "lib/transfer_slabs.wgsl",
            "slab_part(first + 1, 2)",
            "slab_part(first, 2)",
        ),
        "slices_3d.over.composite.slabs_ramps.linear_fetch.f32.perspective",
    ),
    (
        "cut slabs are as long as whole ones",
        Shader(
            "lib/slab.wgsl",
            "select(back - front, plane_length(world), is_whole)",
            "plane_length(world)",
        ),
        "raycast.planes.composite.slabs_ramps.linear_fetch.f32.perspective",
    ),
    (
        "slabs are lit half a voxel beside their middles",
        Shader(
            "lib/unroll_lit_slabs.wgsl",
            "slab.sample.middle, slab",
            "slab.sample.middle + 0.5, slab",
        ),
        "reference.raycast.ray.composite.lit_slabs.linear_fetch.perspective",
    ),
    (
        "gradients are directions of the grid",
        Shader(
            "lib/gradient_central.wgsl",
            "(frame.voxel_from_world * slope.voxel).xyz",
            "slope.voxel",
        ),
        "raycast.ray.composite.headlight.linear_fetch.f32.perspective",
    ),
    (
        "a contour is as wide whatever the slope",
        Shader(
            "lib/widgets.wgsl",
            "n.y * frame.smallest_spacing * magnitude",
            "n.y * frame.smallest_spacing * 0.2",
        ),
        "raycast.ray.composite.contour.linear_fetch.f32.perspective",
    ),
    (
        "a mixture has the mean of its colours",
        Shader(
            "lib/material_channels.wgsl",
            "let color = select(one.color, color_before, is_opacity);",
            "let color = one.color;",
        ),
        "raycast.ray.composite.opacity_beside.linear_fetch.f32.perspective",
    ),
    (
        "a volume on a grid of its own is read where the first one is",
        Shader(
            "lib/channels_on_own.wgsl",
            "dot(frame.channel_from_voxel[row], p)",
            "place.x",
        ),
        "raycast.ray.composite.own_grid.linear_fetch.f32.perspective",
    ),
    (
        "colours of a mixture are added",
        Shader(
            "lib/material_channels.wgsl",
            "light / extinction",
            "min(light, vec3(1.0))",
        ),
        "slices_3d.over.composite.channels.linear_fetch.f32.perspective",
    ),
    (
        "clip planes do not cut where a ray leaves",
        Shader("lib/clipped_cut.wgsl", "min(interval.y, t)", "interval.y"),
        "slices_2d.over.composite.clipped.linear_fetch.f32.perspective",
    ),
    (
        "the extreme of a cell is one of its ends",
        Shader(
            "lib/cell_cubic.wgsl",
            "roots.x = a1 / sum;",
            "roots.x = -1.0;",
        ),
        "raycast.ray.mip.exact.linear_fetch.f32.*|raycast.ray.minip.exact.linear_fetch.f32.*",
    ),
    (
        "a wrong weight of Catmull and Rom",
        Shader("lib/kernel.wgsl", "3.0 * f - 5.0", "3.0 * f - 4.99"),
        "raycast.ray.lmip.waves.catmull_rom.f32.perspective",
    ),
    (
        "a wrong weight of the quadratic",
        Shader("lib/kernel.wgsl", "0.5 + f * g", "0.499 + f * g"),
        "raycast.ray.xray.marschner_lobb.quadratic_smooth.f32.perspective",
    ),
    (
        "the first piece of a way to a light is dropped",
        Shader("light_volume.wgsl", "var i = first;", "var i = first + 1u;"),
        "raycast.ray.composite.shadows.linear_fetch.f32.perspective",
    ),
    (
        "cells absorb what they show",
        Shader(
            "light_cells.wgsl",
            "extinction_of(amount, light_grid.cell_length),",
            "amount,",
        ),
        "slices_3d.over.composite.shadows.linear_fetch.f32.perspective",
    ),
    (
        "each light has the shadow of the first",
        Shader(
            "lib/light.wgsl",
            "frame.shadow_bundle + lamp",
            "frame.shadow_bundle",
        ),
        "raycast.ray.composite.soft_shadows.linear_fetch.f32.perspective",
    ),
    (
        "light is read half a cell too near",
        Shader(
            "lib/light.wgsl",
            "frame.light_reach * towards",
            "0.5 * frame.light_reach * towards",
        ),
        "slices_2d.over.composite.occluded.linear_fetch.f32.orthographic",
    ),
    (
        "nodes of light are weighed the wrong way round",
        Shader(
            "lib/light.wgsl",
            "select(1.0 - cell.part, cell.part, corner",
            "select(cell.part, 1.0 - cell.part, corner",
        ),
        "raycast.ray.composite.occluded.linear_fetch.f32.perspective",
    ),
    (
        "what a crop cuts away still takes light",
        Shader("light_cells.wgsl", "return share;", "return 1.0;"),
        "raycast.ray.composite.occluded.linear_fetch.f32.perspective",
    ),
    (
        "samples near a seam of bricks belong to both",
        Shader(
            "lib/brick.wgsl",
            "all(voxel < frame.brick_max)",
            "all(voxel < frame.brick_max + 0.1)",
        ),
        "relation.in_bricks.raycast.ray.composite.perspective",
    ),
    (
        "samples near a seam of bricks belong to none",
        Shader(
            "lib/brick.wgsl",
            "all(voxel >= frame.brick_min)",
            "all(voxel >= frame.brick_min + 0.1)",
        ),
        "relation.in_bricks.slices_3d.xray.*",
    ),
    (
        "light is taken a little less than it is",
        Shader(
            "lib/light_buffer.wgsl",
            "return 1.0 - between_texels",
            "return 1.0 - 0.99 * between_texels",
        ),
        "slices_3d.half_angle.from_behind.*",
    ),
];
