// Where rays meet the slices of a stack or what lies between them, fractions too: s = rise / slope.

#import ray

// Rays with less run along the slices.
fn least_slope() -> f32 {
    return 0.01 / frame.smallest_spacing;
}

// Whether a cube of voxel space meets what lies between two planes: the box around the samples is as thick as that.
fn is_at_planes(center: vec3<f32>, half: f32, planes: vec2<f32>) -> bool {
    return true;
}

fn plane_slope(world: Ray, voxel: Ray) -> f32 {
    return voxel.direction[frame.slice_axis];
}

fn plane_rise(world: Ray, voxel: Ray, plane: f32) -> f32 {
    return 0.5 + (plane + frame.cover_offset) / frame.planes_per_slice - voxel.origin[frame.slice_axis];
}
