// Empty space of pictures that show a transfer function, but in which a value counts though it is not seen.

#import distance_map

struct CellRanges {
    // Smallest and largest value (shaders/macro_cells.wgsl).
    d: array<vec2<f32>>,
}

@group(0) @binding(39) var<storage, read> cell_ranges: CellRanges;

// 0: there may be matter, or the mode says that the largest value of the cell counts. Cells behind it may have another.
fn empty_distance(so_far: Accumulator, cell: vec3<i32>) -> i32 {
    return i32(distance_to_occupied(cell) > 0 && is_passed_over(so_far, cell_ranges.d[cell_index(cell)].y));
}
