// The voxels with a weight in a kernel inside a slice.

#import stack
#import kernel

fn footprint_of(place: Place) -> Footprint {
    var found = kernel_footprint(place.voxel);
    found.min[frame.slice_axis] = place.slice;
    found.max[frame.slice_axis] = place.slice;
    return found;
}
