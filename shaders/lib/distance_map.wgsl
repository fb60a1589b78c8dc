// How far away from each macro cell the nearest one with matter is (shaders/distance_map.wgsl).

#import empty_space
#import distance_map_word

struct DistanceMap {
    d: array<u32>,
}

@group(0) @binding(36) var<storage, read> distance_map: DistanceMap;

// In cells. 0: there may be matter.
fn distance_to_occupied(cell: vec3<i32>) -> i32 {
    let place = vec3<u32>(cell);
    let word = distance_map.d[distance_map_word(frame.cells_first, frame.cells, vec3(place.x / CELLS_PER_WORD, place.yz))];
    return i32((word >> (8u * (place.x % CELLS_PER_WORD))) & 255u);
}
