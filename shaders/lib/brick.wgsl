// A volume too large for one texture lies in bricks. A sample belongs to the brick whose part of the grid
// it lies in: each to one, so bricks in order leave the samples of a ray as they are.
// CPU reference: none, the CPU has one brick.

#import ray

fn is_in_brick(voxel: vec3<f32>) -> bool {
    return frame.is_only_brick != 0u || (all(voxel >= frame.brick_min) && all(voxel < frame.brick_max));
}

// Where the ray may have samples in the brick, a little more on both sides.
fn brick_interval(voxel: Ray, interval: vec2<f32>) -> vec2<f32> {
    if frame.is_only_brick != 0u {
        return interval;
    }
    let tiny = vec3(1e-20);
    let direction = select(voxel.direction, tiny, abs(voxel.direction) < tiny);
    let at_min = (frame.brick_min - voxel.origin) / direction;
    let at_max = (frame.brick_max - voxel.origin) / direction;
    let enter = min(at_min, at_max);
    let leave = max(at_min, at_max);
    return vec2(
        max(interval.x, max(max(enter.x, enter.y), enter.z) - frame.step_world),
        min(interval.y, min(min(leave.x, leave.y), leave.z) + frame.step_world),
    );
}
