// How far away from each macro cell the nearest one with matter is (shaders/distance_map.wgsl).

#import empty_space
#import room_word

struct Rooms {
    d: array<u32>,
}

@group(0) @binding(36) var<storage, read> rooms: Rooms;

// In cells. 0: there may be matter.
fn room_of(cell: vec3<i32>) -> i32 {
    let place = vec3<u32>(cell);
    let word = rooms.d[room_word(frame.cells_first, frame.cells, vec3(place.x / ROOMS_A_WORD, place.yz))];
    return i32((word >> (8u * (place.x % ROOMS_A_WORD))) & 255u);
}
