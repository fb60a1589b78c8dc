// One more than a buffer has at the pixel's place. Pictures are 64 pixels wide.

struct Numbers {
    d: array<f32>,
}

@group(0) @binding(2) var<storage, read> before: Numbers;

@fragment
fn main(@builtin(position) at: vec4<f32>, @location(0) @interpolate(flat) color: vec4<f32>) -> @location(0) vec4<f32> {
    return color * (before.d[64u * u32(at.y) + u32(at.x)] + 1.0);
}
