// The voxels with a weight in bilinear interpolation inside a slice.

#import frame
#import footprint

fn footprint_of(place: Place) -> Footprint {
    let lattice = place.voxel - 0.5;
    let below = floor(lattice);
    let last = vec3<i32>(frame.dims) - 1;
    let above = select(below, below + 1.0, lattice > below);
    var low = clamp(vec3<i32>(below), vec3(0), last);
    var high = clamp(vec3<i32>(above), vec3(0), last);
    low[frame.slice_axis] = place.slice;
    high[frame.slice_axis] = place.slice;
    return Footprint(low, high);
}
