// A composited picture is premultiplied colour already.

#import frame

@group(0) @binding(1) var picture: texture_2d<f32>;

fn premultiplied(pixel: vec2<i32>) -> vec4<f32> {
    return textureLoad(picture, pixel, 0);
}
