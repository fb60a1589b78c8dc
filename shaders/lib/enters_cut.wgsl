// Whether a ray enters through what has cut the volume.

#import ray

// Neither at the eye nor through a face of the grid box; a cut so near to one is none.
fn enters_a_cut(voxel: Ray, interval: vec2<f32>) -> bool {
    if frame.cut_faces == 0u {
        return false;
    }
    let tiny = vec3(1e-20);
    let direction = select(voxel.direction, tiny, abs(voxel.direction) < tiny);
    let enter = min(-voxel.origin / direction, (frame.dims - voxel.origin) / direction);
    let uncut = max(max(enter.x, enter.y), max(enter.z, 0.0));
    return interval.x > uncut + 1e-3 * frame.step_world;
}
