// As filter_linear.wgsl, of a whole texture.

#import own_footprint_linear

fn filtered_on_own(values: Values, coding: Coding, own: vec3<f32>) -> f32 {
    let texture = own / vec3<f32>(textureDimensions(values));
    let texel = textureSampleLevel(values, volume_sampler, texture, 0.0).x;
    return value_from_code(coding, code_from_mixed_texels(coding, texel));
}
