// The pixel of a slice that a position lies in.

#import stack
#import footprint

fn nearest_footprint(place: Place) -> Footprint {
    var index = clamp(vec3<i32>(floor(place.voxel)), vec3(0), vec3<i32>(frame.dims) - 1);
    index[frame.slice_axis] = place.slice;
    return Footprint(index, index);
}

fn nearest(values: Values, coding: Coding, place: Place) -> f32 {
    let texel = texel_of(nearest_footprint(place).min);
    return value_from_code(coding, code_from_texel(coding, textureLoad(values, texel.xy, texel.z, 0).x));
}
