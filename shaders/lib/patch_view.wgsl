// Where rays meet view-aligned planes, fractions of planes too: s = rise / slope.

#import ray

// Rays with less run along the planes.
fn least_slope() -> f32 {
    return 0.01;
}

// Whether a cube of voxel space with half a side of `half` meets what lies between two planes.
fn is_at_planes(center: vec3<f32>, half: f32, planes: vec2<f32>) -> bool {
    let zero = vec4(vec3(0.0), 1.0) * frame.world_from_voxel;
    let height = dot(frame.forward_voxel, center) + dot(frame.forward, zero);
    let reach = half * dot(abs(frame.forward_voxel), vec3(1.0));
    let ends = (planes + 0.5) * frame.step_world;
    return height + reach >= ends.x && height - reach <= ends.y;
}

fn plane_slope(world: Ray, voxel: Ray) -> f32 {
    return dot(frame.forward, world.direction);
}

fn plane_rise(world: Ray, voxel: Ray, plane: f32) -> f32 {
    return (plane + 0.5) * frame.step_world - dot(frame.forward, world.origin);
}
