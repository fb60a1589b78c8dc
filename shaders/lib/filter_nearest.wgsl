// The value of the voxel that the position lies in.

#import value

@group(0) @binding(1) var volume: texture_3d<f32>;

struct Footprint {
    min: vec3<i32>,
    max: vec3<i32>,
}

fn footprint_of(voxel: vec3<f32>) -> Footprint {
    let index = clamp(vec3<i32>(floor(voxel)), vec3(0), vec3<i32>(frame.dims) - 1);
    return Footprint(index, index);
}

fn value_at(voxel: vec3<f32>) -> f32 {
    let index = footprint_of(voxel).min - vec3<i32>(frame.brick_origin);
    return value_from_code(code_from_texel(textureLoad(volume, index, 0).x));
}
