// Light that matter elsewhere takes away, from the light volume (shaders/light_volume.wgsl): with o what comes in from
// all around and s the strength,
//
//     ambient light at p = 1 - s (1 - o(p + d v))        light i at p: t_i(p + d l_i)
//
// v is the way to the eye and l that to the light, d the length of a cell: a surface is a cell thick there, and would
// keep light from itself. Between nodes trilinear, eight loads of a buffer and no texture:
// the same on every device. CPU reference: src/technique/light_field.rs.

#import frame

struct LightVolume {
    // Of each node, x fastest; bundle after bundle.
    d: array<f32>,
}

@group(0) @binding(29) var<storage, read> light_volume: LightVolume;

// Part of the light from all around, seen along a ray.
fn ambient_at(voxel: vec3<f32>, ray_direction: vec3<f32>) -> f32 {
    let is_on = frame.occlusion_strength != 0.0;
    return 1.0 - frame.occlusion_strength * (1.0 - light_through(0u, voxel, -ray_direction, is_on));
}

// Part of the light of a lamp.
fn lamp_at(lamp: u32, voxel: vec3<f32>) -> f32 {
    let towards = frame.light_directions[lamp];
    // Nothing that the eye sees is in the shadow of a light at the eye.
    let is_on = frame.has_shadows != 0u && towards.w == 0.0;
    return light_through(frame.shadow_bundle + lamp, voxel, towards.xyz, is_on);
}

// Where it is not on, a loop of no turns: drivers that go through both sides of a branch look at one corner, not eight.
fn light_through(bundle: u32, voxel: vec3<f32>, towards: vec3<f32>, is_on: bool) -> f32 {
    let nearer = voxel + vec4(frame.light_reach * towards, 0.0) * frame.voxel_from_world;
    let cell = light_cell(bundle, nearer);
    let corners = select(0u, 8u, is_on);
    var open = 0.0;
    for (var i = 0u; i < corners; i++) {
        let corner = light_corner(cell, i);
        open += corner.weight * corner.open;
    }
    return select(1.0, open, is_on);
}

// Between eight nodes of a bundle. What does not change from node to node stands here: drivers do not lift it out of loops.
struct LightCell {
    low: vec3<f32>,
    part: vec3<f32>,
    nodes: vec3<u32>,
    bundle: u32,
    // What stands in where there is no light volume is shorter.
    last: u32,
}

fn light_cell(bundle: u32, voxel: vec3<f32>) -> LightCell {
    let at = clamp(voxel * frame.light_cells_per_voxel, vec3(0.0), frame.light_cells);
    let low = min(floor(at), frame.light_cells - 1.0);
    let nodes = vec3<u32>(frame.light_cells) + 1u;
    return LightCell(low, at - low, nodes, bundle, arrayLength(&light_volume.d) - 1u);
}

// A node, what comes through to it, and its share of a place between the eight.
struct LightCorner {
    weight: f32,
    open: f32,
}

fn light_corner(cell: LightCell, i: u32) -> LightCorner {
    let corner = vec3(i & 1u, (i >> 1u) & 1u, i >> 2u);
    let weights = select(1.0 - cell.part, cell.part, corner != vec3(0u));
    let node = vec3<u32>(cell.low) + corner;
    let index = node.x + cell.nodes.x * (node.y + cell.nodes.y * (node.z + cell.nodes.z * cell.bundle));
    let open = light_volume.d[min(index, cell.last)];
    return LightCorner(weights.x * weights.y * weights.z, open);
}
