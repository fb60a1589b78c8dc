// A value that a share of the rays around a pixel has: classified once, its alpha times that share. No ray has one:
// transparent.

#import points

@group(0) @binding(1) var accumulation: texture_2d<f32>;

fn premultiplied(pixel: vec2<i32>) -> vec4<f32> {
    let found = textureLoad(accumulation, pixel, 0);
    if found.y == 0.0 {
        return vec4(0.0);
    }
    let opacity = found.y * opacity_at(found.x);
    return vec4(opacity * color_at(found.x), opacity);
}
