// 2D texture slicing, the cover: one rectangle a slice (or a plane, or a slab between planes), as large as the
// enlarged domain.

#import slice_order
#import vertex_{parameters}

const CORNERS = array<vec2<f32>, 6>(
    vec2(0.0, 0.0),
    vec2(1.0, 0.0),
    vec2(1.0, 1.0),
    vec2(0.0, 0.0),
    vec2(1.0, 1.0),
    vec2(0.0, 1.0),
);

@vertex
fn main(@builtin(vertex_index) index: u32, @builtin(instance_index) instance: u32) -> Vertex {
    var corners = CORNERS;
    let slice = slice_of(instance);
    let axis = frame.slice_axis;
    // A slice that the eye lies in has no picture of its own, yet every ray has its first sample there: the
    // fragments decide, all of them.
    let eye = vec4(frame.origin, 1.0) * frame.voxel_from_world;
    let height = 0.5 + (f32(slice) + frame.cover_offset) / frame.planes_per_slice;
    if abs(eye[axis] - height) < frame.cover_eye_reach {
        return vertex_of(vec4(2.0 * corners[index] - 1.0, frame.host_near, 1.0), slice, 1.0);
    }
    var part = vec3(0.0);
    part[(axis + 1u) % 3u] = corners[index].x;
    part[(axis + 2u) % 3u] = corners[index].y;
    var voxel = select(frame.cover_min, frame.cover_max, part != vec3(0.0));
    voxel[axis] = height;
    let world = vec4(voxel, 1.0) * frame.world_from_voxel;
    return vertex_of(vec4(world, 1.0) * frame.clip_from_world, slice, 1.0);
}
