// Stores at places that may lie beyond the image.

struct Places {
    d: array<vec4<i32>>,
}

@group(0) @binding(0) var stored: texture_storage_2d<rgba32float, write>;
@group(0) @binding(1) var<storage, read> places: Places;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&places.d) {
        return;
    }
    textureStore(stored, places.d[id.x].xy, vec4(7.0));
}
