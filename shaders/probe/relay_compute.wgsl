// Half of what a picture has at the place of the pixel's right neighbour, row by row.

struct Numbers {
    d: array<f32>,
}

@group(0) @binding(0) var drawn: texture_2d<f32>;
@group(0) @binding(1) var<storage, read_write> after: Numbers;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let dims = textureDimensions(drawn);
    let place = vec2((id.x + 1u) % dims.x, id.x / dims.x);
    after.d[id.x] = 0.5 * textureLoad(drawn, vec2<i32>(place), 0).x;
}
