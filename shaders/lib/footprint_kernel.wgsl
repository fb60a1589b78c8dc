// The voxels with a weight in a kernel.

#import kernel

fn footprint_of(voxel: vec3<f32>) -> Footprint {
    return kernel_footprint(voxel);
}
