// Empty space of pictures that show a transfer function: how far away the nearest cell with matter is
// (shaders/distance_map.wgsl).

#import empty_space

struct Rooms {
    d: array<u32>,
}

@group(0) @binding(36) var<storage, read> rooms: Rooms;

// 0: there may be matter, or nothing is known.
fn empty_room(so_far: Accumulator, position: vec3<f32>) -> u32 {
    if frame.cells.x == 0u {
        return 0u;
    }
    return rooms.d[macro_cell_index_at(position)];
}
