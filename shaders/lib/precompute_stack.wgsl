// Where gradients of a stack of slices are kept.

#import stack_nearest

@group(0) @binding(2) var kept: texture_storage_2d_array<rgba16float, write>;

fn keep(voxel: vec3<i32>, slope: vec3<f32>) {
    let texel = texel_in_brick(voxel);
    textureStore(kept, texel.xy, texel.z, vec4(slope, 0.0));
}
