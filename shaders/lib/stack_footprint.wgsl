// The voxels with a weight in bilinear interpolation inside a slice.

#import frame

struct Footprint {
    min: vec3<i32>,
    max: vec3<i32>,
}

fn footprint_of(voxel: vec3<f32>, slice: i32) -> Footprint {
    let lattice = voxel - 0.5;
    let below = floor(lattice);
    let last = vec3<i32>(frame.dims) - 1;
    let above = select(below, below + 1.0, lattice > below);
    var low = clamp(vec3<i32>(below), vec3(0), last);
    var high = clamp(vec3<i32>(above), vec3(0), last);
    low[frame.slice_axis] = slice;
    high[frame.slice_axis] = slice;
    return Footprint(low, high);
}
