// B-splines inside a slice by four linear fetches: as exact as the sampler's sub-texel bits.

#import stack
#import stack_footprint_kernel
#import kernel_pairs

@group(0) @binding(2) var volume_sampler: sampler;

fn filtered(values: Values, coding: Coding, place: Place) -> f32 {
    let pairs = kernel_pairs(place.voxel);
    let size = in_stack(frame.brick_dims).xy;
    let low = in_stack(pairs.low - frame.brick_origin).xy / size;
    let high = in_stack(pairs.high - frame.brick_origin).xy / size;
    let weight = in_stack(pairs.weight);
    let layer = place.slice - i32(frame.brick_origin[frame.slice_axis]);
    let above = lerp(texel(values, low, layer), texel(values, vec2(high.x, low.y), layer), weight.x);
    let below = lerp(texel(values, vec2(low.x, high.y), layer), texel(values, high, layer), weight.x);
    return value_from_code(coding, code_from_mixed_texels(coding, lerp(above, below, weight.y)));
}

fn texel(values: Values, texture: vec2<f32>, layer: i32) -> f32 {
    return textureSampleLevel(values, volume_sampler, texture, layer, 0.0).x;
}
