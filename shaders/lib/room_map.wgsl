// How far away from each macro cell the nearest one with matter is (shaders/distance_map.wgsl).

#import empty_space

struct Rooms {
    d: array<u32>,
}

@group(0) @binding(36) var<storage, read> rooms: Rooms;

// In place of a distance: there is matter, and samples look alike.
const ROOM_ALIKE: i32 = 0x40000000;

// In cells. 0: there may be matter.
fn room_of(cell: vec3<i32>) -> i32 {
    return i32(rooms.d[cell_index(cell)]);
}
