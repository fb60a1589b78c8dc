// Numbers as they are loaded from a storage image, row by row.

#import probe_load_{format}

struct Numbers {
    d: array<vec4<Number>>,
}

@group(0) @binding(1) var<storage, read_write> numbers: Numbers;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let dims = textureDimensions(loaded);
    if any(id.xy >= dims) {
        return;
    }
    numbers.d[id.y * dims.x + id.x] = textureLoad(loaded, vec2<i32>(id.xy));
}
