// Bilinear inside the slice from four texel fetches: the same on every device. Across first, then down.

#import stack_layers
#import stack_footprint

fn value_at(voxel: vec3<f32>, slice: i32) -> f32 {
    let taps = footprint_of(voxel, slice);
    let low = texel_of(taps.min);
    let high = texel_of(taps.max);
    let weight = fract(in_stack(voxel).xy - 0.5);
    let above = lerp(code_at(low), code_at(vec3(high.x, low.yz)), weight.x);
    let below = lerp(code_at(vec3(low.x, high.y, low.z)), code_at(high), weight.x);
    return value_from_code(lerp(above, below, weight.y));
}

fn code_at(texel: vec3<i32>) -> f32 {
    return code_from_texel(textureLoad(stack, texel.xy, texel.z, 0).x);
}
