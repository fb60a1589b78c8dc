// A stack's images: slice s of axis k is layer s, with axis (k + 1) mod 3 across and (k + 2) mod 3 down.

#import value

alias Values = texture_2d_array<f32>;
alias Mask = texture_2d_array<u32>;

// A position in voxel space on a slice.
struct Place {
    voxel: vec3<f32>,
    slice: i32,
}

@group(0) @binding(1) var stack: Values;

fn volume_value(place: Place) -> f32 {
    return filtered(stack, volume_coding(), place);
}

// The position so many voxels away: across the stack in another slice, the outermost at most.
fn shifted(place: Place, voxels: vec3<f32>) -> Place {
    let axis = frame.slice_axis;
    let slice = clamp(place.slice + i32(voxels[axis]), 0, i32(frame.dims[axis]) - 1);
    return Place(place.voxel + voxels, slice);
}

// Its position in voxel space, on the slice exactly.
fn voxel_of(place: Place) -> vec3<f32> {
    var voxel = place.voxel;
    voxel[frame.slice_axis] = f32(place.slice) + 0.5;
    return voxel;
}

// The texel of a voxel, the nearest that the brick holds.
fn texel_at(values: Values, voxel: vec3<i32>) -> vec4<f32> {
    let texel = texel_in_brick(voxel);
    return textureLoad(values, texel.xy, texel.z, 0);
}

fn linear_texel_at(values: Values, linear: sampler, place: Place) -> vec4<f32> {
    let texture = in_stack(place.voxel - frame.brick_origin).xy / in_stack(frame.brick_dims).xy;
    return textureSampleLevel(values, linear, texture, place.slice - i32(frame.brick_origin[frame.slice_axis]), 0.0);
}

fn texel_in_brick(voxel: vec3<i32>) -> vec3<i32> {
    let first = vec3<i32>(frame.brick_origin);
    return texel_of(clamp(voxel, first, first + vec3<i32>(frame.brick_dims) - 1));
}

// A vector of voxel space by the axes of the stack's images: across, down, layer.
fn in_stack(voxel: vec3<f32>) -> vec3<f32> {
    let axis = frame.slice_axis;
    return vec3(voxel[(axis + 1u) % 3u], voxel[(axis + 2u) % 3u], voxel[axis]);
}

// Where a voxel lies in the images of the brick.
fn texel_of(index: vec3<i32>) -> vec3<i32> {
    return vec3<i32>(in_stack(vec3<f32>(index) - frame.brick_origin));
}
