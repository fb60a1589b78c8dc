// Where gradients of a volume as 3D textures are kept.

#import filter_nearest

@group(0) @binding(2) var kept: texture_storage_3d<rgba16float, write>;

fn keep(voxel: vec3<i32>, slope: vec3<f32>) {
    textureStore(kept, texel_in_brick(voxel), vec4(slope, 0.0));
}
