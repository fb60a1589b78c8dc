// What the rasterizer has made of the numbers of the corners, and of their w.

#import probe_varyings

@fragment
fn main(varied: Varyings) -> @location(0) vec4<f32> {
    return vec4(varied.perspective, varied.linear, varied.first, varied.position.w);
}
