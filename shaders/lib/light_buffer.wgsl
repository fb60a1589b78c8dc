// What is left of the light at a point of the centred world: 1 - A of the picture that the light has of the slices
// before this one, interpolated bilinearly between four of its texels. Fetched and not sampled: the same on every
// device, and 32-bit floats need not be filterable. CPU reference: src/technique/slices_3d/half_angle/reference.rs.

#import frame

@group(0) @binding(34) var light_buffer: texture_2d<f32>;

fn light_at(world: vec3<f32>) -> f32 {
    let point = vec4(world, 1.0);
    // Texel centres lie at whole numbers.
    let texel = vec2(dot(frame.light_rows[0], point), dot(frame.light_rows[1], point)) - 0.5;
    let last = vec2<f32>(textureDimensions(light_buffer)) - 1.0;
    let low = clamp(floor(texel), vec2(0.0), last);
    let high = min(low + 1.0, last);
    let part = clamp(texel - low, vec2(0.0), vec2(1.0));
    let upper = between_texels(taken_at(low.x, low.y), taken_at(high.x, low.y), part.x);
    let lower = between_texels(taken_at(low.x, high.y), taken_at(high.x, high.y), part.x);
    return 1.0 - between_texels(upper, lower, part.y);
}

fn taken_at(x: f32, y: f32) -> f32 {
    return textureLoad(light_buffer, vec2(i32(x), i32(y)), 0).w;
}

// Exact where both ends are equal, unlike `mix`.
fn between_texels(a: f32, b: f32, part: f32) -> f32 {
    return a + part * (b - a);
}
