// One triangle over the whole target.

@vertex
fn main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    return vec4(corner * 4.0 - 1.0, 0.5, 1.0);
}
