// The voxel that a position lies in.

#import box
#import footprint

fn nearest_footprint(voxel: vec3<f32>) -> Footprint {
    let index = clamp(vec3<i32>(floor(voxel)), vec3(0), vec3<i32>(frame.dims) - 1);
    return Footprint(index, index);
}

fn nearest(values: Values, coding: Coding, voxel: vec3<f32>) -> f32 {
    let index = nearest_footprint(voxel).min - vec3<i32>(frame.brick_origin);
    return value_from_code(coding, code_from_texel(coding, textureLoad(values, index, 0).x));
}
