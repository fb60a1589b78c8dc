// What the vertices of view-aligned slices hand over: which slice it is, and the parameters of rays and voxels, since
// a driver on the processor takes long over those that fragments ask for. `shaders/flat_varyings.rs` lets fragments take them
// from here.

#import frame

struct Vertex {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) slice: i32,
    @location(1) @interpolate(flat) origin: vec4<u32>,
    @location(2) @interpolate(flat) origin_dx: vec4<u32>,
    @location(3) @interpolate(flat) origin_dy: vec4<u32>,
    @location(4) @interpolate(flat) direction: vec4<u32>,
    @location(5) @interpolate(flat) direction_dx: vec4<u32>,
    @location(6) @interpolate(flat) direction_dy: vec4<u32>,
    @location(7) @interpolate(flat) domain_min: vec4<u32>,
    @location(8) @interpolate(flat) domain_max: vec4<u32>,
    @location(9) @interpolate(flat) brick_min: vec4<u32>,
    @location(10) @interpolate(flat) brick_max: vec4<u32>,
    @location(11) @interpolate(flat) voxel_from_world: vec4<u32>,
    @location(12) @interpolate(flat) voxel_from_world_y: vec4<u32>,
    @location(13) @interpolate(flat) voxel_from_world_z: vec4<u32>,
    @location(14) @interpolate(flat) forward: vec4<u32>,
    @location(15) @interpolate(flat) dims: vec4<u32>,
    // The size of a point, which WGSL has no word for (`shaders/point_size.rs`).
    @location(31) point_pixels: f32,
}

fn vertex_of(position: vec4<f32>, slice: i32, point_pixels: f32) -> Vertex {
    return Vertex(
        position,
        slice,
        row(frame.origin, bitcast<u32>(frame.table_scale)),
        row(frame.origin_dx, frame.is_uneven),
        row(frame.origin_dy, bitcast<u32>(frame.table_first)),
        row(frame.direction, bitcast<u32>(frame.code_offset)),
        row(frame.direction_dx, bitcast<u32>(frame.slope)),
        row(frame.direction_dy, bitcast<u32>(frame.intercept)),
        row(frame.domain_min, frame.clip_plane_count),
        row(frame.domain_max, frame.table_count),
        row(frame.brick_min, frame.is_only_brick),
        row(frame.brick_max, bitcast<u32>(frame.code_scale)),
        bitcast<vec4<u32>>(frame.voxel_from_world[0]),
        bitcast<vec4<u32>>(frame.voxel_from_world[1]),
        bitcast<vec4<u32>>(frame.voxel_from_world[2]),
        row(frame.forward, bitcast<u32>(frame.step_world)),
        row(frame.dims, bitcast<u32>(frame.reference_length)),
        point_pixels,
    );
}

fn row(first: vec3<f32>, last: u32) -> vec4<u32> {
    return vec4(bitcast<vec3<u32>>(first), last);
}
