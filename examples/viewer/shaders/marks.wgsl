// Marks, linear light times opacity, pixel on pixel over what the picture holds: the pipeline blends.

@group(0) @binding(1) var image: texture_2d<f32>;

// One triangle that covers the viewport.
@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let uv = vec2(f32((index << 1u) & 2u), f32(index & 2u));
    return vec4(2.0 * uv - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) place: vec4<f32>) -> @location(0) vec4<f32> {
    return textureLoad(image, vec2<i32>(place.xy), 0);
}
