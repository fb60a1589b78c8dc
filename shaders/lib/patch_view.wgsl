// Where rays meet view-aligned planes, fractions of planes too: s = rise / slope.

#import ray

// Rays with less run along the planes.
fn least_slope() -> f32 {
    return 0.01;
}

fn plane_slope(world: Ray, voxel: Ray) -> f32 {
    return dot(frame.forward, world.direction);
}

fn plane_rise(world: Ray, voxel: Ray, plane: f32) -> f32 {
    return (plane + 0.5) * frame.step_world - dot(frame.forward, world.origin);
}
