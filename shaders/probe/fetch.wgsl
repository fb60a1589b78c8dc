// Texels as they are fetched, x fastest, as the bits of f32.

struct Found {
    d: array<u32>,
}

@group(0) @binding(0) var probed: texture_3d<f32>;
@group(0) @binding(1) var<storage, read_write> found: Found;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let dims = textureDimensions(probed);
    if id.x >= dims.x * dims.y * dims.z {
        return;
    }
    let place = vec3(id.x % dims.x, (id.x / dims.x) % dims.y, id.x / (dims.x * dims.y));
    found.d[id.x] = bitcast<u32>(textureLoad(probed, vec3<i32>(place), 0).x);
}
