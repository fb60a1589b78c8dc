// What the device's sampler makes of places in a 2D-array texture: texture coordinates and layer in, first channels
// out.

struct Places {
    d: array<vec4<f32>>,
}

struct Found {
    d: array<f32>,
}

@group(0) @binding(0) var probed: texture_2d_array<f32>;
@group(0) @binding(1) var probed_sampler: sampler;
@group(0) @binding(2) var<storage, read> places: Places;
@group(0) @binding(3) var<storage, read_write> found: Found;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&places.d) {
        return;
    }
    let place = places.d[id.x];
    found.d[id.x] = textureSampleLevel(probed, probed_sampler, place.xy, i32(place.z), 0.0).x;
}
