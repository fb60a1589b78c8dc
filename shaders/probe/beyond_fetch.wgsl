// Texels at places that may lie beyond the image, of a texture and of a storage image.

struct Places {
    d: array<vec4<i32>>,
}

struct Found {
    d: array<vec4<f32>>,
}

@group(0) @binding(0) var probed: texture_3d<f32>;
@group(0) @binding(1) var loaded: texture_storage_2d<rgba32float, read>;
@group(0) @binding(2) var<storage, read> places: Places;
@group(0) @binding(3) var<storage, read_write> found: Found;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&places.d) {
        return;
    }
    let place = places.d[id.x];
    found.d[2u * id.x] = textureLoad(probed, place.xyz, 0);
    found.d[2u * id.x + 1u] = textureLoad(loaded, place.xy);
}
