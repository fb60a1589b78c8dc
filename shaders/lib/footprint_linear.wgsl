// The voxels with a weight in trilinear interpolation: one on an axis where the position is a centre.

#import frame
#import footprint

fn footprint_of(voxel: vec3<f32>) -> Footprint {
    return linear_footprint(voxel, frame.dims);
}

fn linear_footprint(voxel: vec3<f32>, dims: vec3<f32>) -> Footprint {
    let lattice = voxel - 0.5;
    let below = floor(lattice);
    let last = vec3<i32>(dims) - 1;
    let above = select(below, below + 1.0, lattice > below);
    return Footprint(
        clamp(vec3<i32>(below), vec3(0), last),
        clamp(vec3<i32>(above), vec3(0), last),
    );
}
