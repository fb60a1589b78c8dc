// A composited picture is premultiplied colour already: light, which a tone may change.

#import frame
#import tone

@group(0) @binding(1) var picture: texture_2d<f32>;

fn premultiplied(pixel: vec2<i32>) -> vec4<f32> {
    return toned(textureLoad(picture, pixel, 0));
}
