// Empty space of pictures that show a transfer function.

#import distance_map

// 0: there may be matter.
fn empty_distance(so_far: Accumulator, cell: vec3<i32>) -> i32 {
    return distance_to_occupied(cell);
}
