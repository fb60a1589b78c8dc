// Infinities and what is no number, as a storage image keeps them: compiled so that shaders preserve them.

#import probe_store_{format}

struct Numbers {
    d: array<vec4<Number>>,
}

@group(0) @binding(1) var<storage, read> numbers: Numbers;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let dims = textureDimensions(stored);
    if any(id.xy >= dims) {
        return;
    }
    textureStore(stored, vec2<i32>(id.xy), numbers.d[id.y * dims.x + id.x]);
}
