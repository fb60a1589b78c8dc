// As filter_linear_fetch.wgsl, of a whole texture.

#import own_footprint_linear

fn filtered_on_own(values: Values, coding: Coding, own: vec3<f32>) -> f32 {
    return filtered_between(values, coding, own_footprint(own, vec3<f32>(textureDimensions(values))), fract(own - 0.5));
}
