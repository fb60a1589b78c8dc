// Where rays meet the slices of a stack or what lies between them, fractions too: s = rise / slope.

#import ray

// Rays with less run along the slices.
fn least_slope() -> f32 {
    return 0.01 / frame.smallest_spacing;
}

fn plane_slope(world: Ray, voxel: Ray) -> f32 {
    return voxel.direction[frame.slice_axis];
}

fn plane_rise(world: Ray, voxel: Ray, plane: f32) -> f32 {
    return 0.5 + (plane + frame.cover_offset) / frame.planes_per_slice - voxel.origin[frame.slice_axis];
}
