// A projected value is classified once; its alpha is the opacity itself. No valid sample: transparent.

#import points

@group(0) @binding(1) var accumulation: texture_2d<f32>;

fn premultiplied(pixel: vec2<i32>) -> vec4<f32> {
    let found = textureLoad(accumulation, pixel, 0);
    if found.y == 0.0 {
        return vec4(0.0);
    }
    let opacity = opacity_at(found.x);
    return vec4(opacity * color_at(found.x), opacity);
}
