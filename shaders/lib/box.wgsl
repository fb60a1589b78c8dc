// A volume as 3D textures: what is looked up, and where.

#import value

alias Values = texture_3d<f32>;
alias Mask = texture_3d<u32>;
// A position in voxel space.
alias Place = vec3<f32>;

@group(0) @binding(1) var volume: Values;

// The position so many voxels away.
fn shifted(place: Place, voxels: vec3<f32>) -> Place {
    return place + voxels;
}

// Where a place is in voxel space.
fn voxel_of(place: Place) -> vec3<f32> {
    return place;
}

// The texel of a voxel, the nearest that the brick holds.
fn texel_at(values: Values, voxel: vec3<i32>) -> vec4<f32> {
    return textureLoad(values, texel_in_brick(voxel), 0);
}

fn linear_texel_at(values: Values, linear: sampler, place: Place) -> vec4<f32> {
    return textureSampleLevel(values, linear, (place - frame.brick_origin) / frame.brick_dims, 0.0);
}

fn texel_in_brick(voxel: vec3<i32>) -> vec3<i32> {
    return clamp(voxel - vec3<i32>(frame.brick_origin), vec3(0), vec3<i32>(frame.brick_dims) - 1);
}

fn volume_value(place: Place) -> f32 {
    return filtered(volume, volume_coding(), place);
}
