// Trilinear by the device's sampler: as exact as its sub-texel bits.

#import value
#import footprint_linear

@group(0) @binding(1) var volume: texture_3d<f32>;
@group(0) @binding(2) var volume_sampler: sampler;

fn value_at(voxel: vec3<f32>) -> f32 {
    let texture = (voxel - frame.brick_origin) / frame.brick_dims;
    let texel = textureSampleLevel(volume, volume_sampler, texture, 0.0).x;
    return value_from_code(code_from_mixed_texels(texel));
}
