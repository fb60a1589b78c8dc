// B-splines by eight linear fetches: as exact as the sampler's sub-texel bits.

#import box
#import footprint_kernel
#import kernel_pairs

@group(0) @binding(2) var volume_sampler: sampler;

fn filtered(values: Values, coding: Coding, voxel: vec3<f32>) -> f32 {
    let pairs = kernel_pairs(voxel);
    let low = (pairs.low - frame.brick_origin) / frame.brick_dims;
    let high = (pairs.high - frame.brick_origin) / frame.brick_dims;
    let weight = pairs.weight;
    let front = lerp(
        row(values, low.x, high.x, low.y, low.z, weight.x),
        row(values, low.x, high.x, high.y, low.z, weight.x),
        weight.y,
    );
    let back = lerp(
        row(values, low.x, high.x, low.y, high.z, weight.x),
        row(values, low.x, high.x, high.y, high.z, weight.x),
        weight.y,
    );
    return value_from_code(coding, code_from_mixed_texels(coding, lerp(front, back, weight.z)));
}

fn row(values: Values, low: f32, high: f32, y: f32, z: f32, weight: f32) -> f32 {
    return lerp(
        textureSampleLevel(values, volume_sampler, vec3(low, y, z), 0.0).x,
        textureSampleLevel(values, volume_sampler, vec3(high, y, z), 0.0).x,
        weight,
    );
}
