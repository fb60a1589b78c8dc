// The gradient at a position in voxel space of a volume that lies in 3D textures.

#import gradient

fn gradient_in(voxel: vec3<f32>) -> vec3<f32> {
    return gradient_at(voxel);
}
