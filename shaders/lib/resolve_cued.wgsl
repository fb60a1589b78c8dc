// A projected value that lies at one place of the ray, classified once and then darkened by its depth: what is
// far is dark (Heidrich, McCool and Stevens 1995 shade a MIP so). Alpha stays. No valid sample: transparent.

#import points

@group(0) @binding(1) var accumulation: texture_2d<f32>;

fn premultiplied(pixel: vec2<i32>) -> vec4<f32> {
    let found = textureLoad(accumulation, pixel, 0);
    if found.y == 0.0 {
        return vec4(0.0);
    }
    let opacity = opacity_at(found.x);
    return vec4(light_at(found.z) * opacity * color_at(found.x), opacity);
}

fn light_at(depth: f32) -> f32 {
    let far = clamp((depth - frame.depth_near) * frame.depth_scale, 0.0, 1.0);
    return 1.0 - frame.depth_cue * far;
}
