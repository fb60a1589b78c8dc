// Cut faces: where a ray enters through what has cut the volume (the crop box, a clip plane), what lies there is a
// sample of its own, before all others, and opaque wherever it is not transparent: its segment is longer than any
// extinction is short. Twin: src/technique/faces.rs.

#import ray

// Exp of -1e30 times any extinction of a table is 0.
const FACE_LENGTH: f32 = 1e30;
// Greys of a window in place of the picture's own colours.
const FACES_GREY: u32 = 2u;

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
