// The picture of the volume, linear light, into its part of the window, sRGB numbers (IEC 61966-2-1).

@group(0) @binding(1) var image: texture_2d<f32>;
@group(0) @binding(2) var smooth_sampler: sampler;

struct Seen {
    @builtin(position) place: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

// One triangle that covers the viewport.
@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Seen {
    let uv = vec2(f32((index << 1u) & 2u), f32(index & 2u));
    return Seen(vec4(2.0 * uv - 1.0, 0.0, 1.0), uv);
}

fn encoded(linear: vec3<f32>) -> vec3<f32> {
    let light = clamp(linear, vec3(0.0), vec3(1.0));
    let low = 12.92 * light;
    let high = 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055;
    return select(high, low, light <= vec3(0.0031308));
}

@fragment
fn fragment(seen: Seen) -> @location(0) vec4<f32> {
    let color = textureSampleLevel(image, smooth_sampler, seen.uv, 0.0);
    return vec4(encoded(color.rgb), 1.0);
}
