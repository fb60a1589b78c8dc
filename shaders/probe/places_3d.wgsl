// Texels at given places, as the bits of f32.

struct Places {
    d: array<vec4<u32>>,
}

struct Found {
    d: array<u32>,
}

@group(0) @binding(0) var probed: texture_3d<f32>;
@group(0) @binding(1) var<storage, read> places: Places;
@group(0) @binding(2) var<storage, read_write> found: Found;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&places.d) {
        return;
    }
    let place = vec3<i32>(places.d[id.x].xyz);
    found.d[id.x] = bitcast<u32>(textureLoad(probed, place, 0).x);
}
