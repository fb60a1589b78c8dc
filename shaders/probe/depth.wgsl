// The colour of the triangle, and a depth of the pixel's own.

struct Numbers {
    d: array<f32>,
}

struct Pixel {
    @location(0) color: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

@group(0) @binding(2) var<storage, read> depths: Numbers;

@fragment
fn main(@builtin(position) at: vec4<f32>, @location(0) @interpolate(flat) color: vec4<f32>) -> Pixel {
    // Pictures are 64 pixels wide.
    return Pixel(color, depths.d[64u * u32(at.y) + u32(at.x)]);
}
