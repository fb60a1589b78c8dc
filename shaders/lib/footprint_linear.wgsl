// The voxels with a weight in trilinear interpolation: one on an axis where the position is a centre.

#import frame
#import footprint

fn footprint_of(voxel: vec3<f32>) -> Footprint {
    let lattice = voxel - 0.5;
    let below = floor(lattice);
    let last = vec3<i32>(frame.dims) - 1;
    let above = select(below, below + 1.0, lattice > below);
    return Footprint(
        clamp(vec3<i32>(below), vec3(0), last),
        clamp(vec3<i32>(above), vec3(0), last),
    );
}
