// Bilinear inside the slice, by the device's sampler.

#import stack_layers
#import stack_footprint

@group(0) @binding(2) var volume_sampler: sampler;

fn value_at(voxel: vec3<f32>, slice: i32) -> f32 {
    let texture = in_stack(voxel - frame.brick_origin).xy / in_stack(frame.brick_dims).xy;
    let layer = slice - i32(frame.brick_origin[frame.slice_axis]);
    let texel = textureSampleLevel(stack, volume_sampler, texture, layer, 0.0).x;
    return value_from_code(code_from_mixed_texels(texel));
}
