// Trilinear by the device's sampler: as exact as its sub-texel bits.

#import box
#import footprint_linear

@group(0) @binding(2) var volume_sampler: sampler;

fn filtered(values: Values, coding: Coding, voxel: vec3<f32>) -> f32 {
    let texture = (voxel - frame.brick_origin) / frame.brick_dims;
    let texel = textureSampleLevel(values, volume_sampler, texture, 0.0).x;
    return value_from_code(coding, code_from_mixed_texels(coding, texel));
}
