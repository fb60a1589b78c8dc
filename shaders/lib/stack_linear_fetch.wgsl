// Bilinear inside the slice from four texel fetches: the same on every device. Across first, then down.

#import stack_layers
#import stack_footprint

fn value_at(voxel: vec3<f32>, slice: i32) -> f32 {
    let taps = footprint_of(voxel, slice);
    let low = vec2<i32>(in_slice(vec3<f32>(taps.min)));
    let high = vec2<i32>(in_slice(vec3<f32>(taps.max)));
    let weight = fract(in_slice(voxel) - 0.5);
    let above = lerp(code_at(low, slice), code_at(vec2(high.x, low.y), slice), weight.x);
    let below = lerp(code_at(vec2(low.x, high.y), slice), code_at(high, slice), weight.x);
    return value_from_code(lerp(above, below, weight.y));
}

fn code_at(pixel: vec2<i32>, slice: i32) -> f32 {
    return code_from_texel(textureLoad(stack, pixel, slice, 0).x);
}
