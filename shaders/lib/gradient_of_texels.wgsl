// The gradient at a position in voxel space by footprint texels: central differences, and no more.

#import gradient_central

fn gradient_in(voxel: vec3<f32>) -> vec3<f32> {
    return gradient_of(central_slope(voxel));
}
