// Bilinear inside the slice, by the device's sampler.

#import stack
#import stack_footprint

@group(0) @binding(2) var volume_sampler: sampler;

fn filtered(values: Values, coding: Coding, place: Place) -> f32 {
    let texture = in_stack(place.voxel - frame.brick_origin).xy / in_stack(frame.brick_dims).xy;
    let layer = place.slice - i32(frame.brick_origin[frame.slice_axis]);
    let texel = textureSampleLevel(values, volume_sampler, texture, layer, 0.0).x;
    return value_from_code(coding, code_from_mixed_texels(coding, texel));
}
