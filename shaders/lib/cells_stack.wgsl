// Voxels in the slices of a stack: the slice that a position lies in.

#import stack_{filter}
#import stack_at_nearest
#import stack_mask

fn place_at(voxel: vec3<f32>) -> Place {
    let axis = frame.slice_axis;
    return Place(voxel, clamp(i32(floor(voxel[axis])), 0, i32(frame.dims[axis]) - 1));
}
