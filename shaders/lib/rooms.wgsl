// Empty space of pictures that show a transfer function: how far away the nearest cell with matter is
// (shaders/distance_map.wgsl).

#import empty_space

struct Rooms {
    d: array<u32>,
}

@group(0) @binding(36) var<storage, read> rooms: Rooms;

// 0: there may be matter.
fn empty_room(so_far: Accumulator, cell: vec3<i32>) -> i32 {
    return i32(rooms.d[cell_index(cell)]);
}
