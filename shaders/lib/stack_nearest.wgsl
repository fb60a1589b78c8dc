// The value of the pixel of the slice that the position lies in.

#import stack_layers

struct Footprint {
    min: vec3<i32>,
    max: vec3<i32>,
}

fn footprint_of(voxel: vec3<f32>, slice: i32) -> Footprint {
    var index = clamp(vec3<i32>(floor(voxel)), vec3(0), vec3<i32>(frame.dims) - 1);
    index[frame.slice_axis] = slice;
    return Footprint(index, index);
}

fn value_at(voxel: vec3<f32>, slice: i32) -> f32 {
    let texel = texel_of(footprint_of(voxel, slice).min);
    return value_from_code(code_from_texel(textureLoad(stack, texel.xy, texel.z, 0).x));
}
