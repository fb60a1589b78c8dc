// As filter_nearest.wgsl, of a whole texture.

fn filtered_on_own(values: Values, coding: Coding, own: vec3<f32>) -> f32 {
    let index = own_footprint(own, vec3<f32>(textureDimensions(values))).min;
    return value_from_code(coding, code_from_texel(coding, textureLoad(values, index, 0).x));
}

fn own_footprint(own: vec3<f32>, dims: vec3<f32>) -> Footprint {
    return own_nearest_footprint(own, dims);
}
