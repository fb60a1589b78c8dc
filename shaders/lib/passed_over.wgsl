// What the mode says cannot count, given what it has so far and the largest value of a cell.

#import empty_space

struct CellRanges {
    // Smallest and largest value (shaders/macro_cells.wgsl).
    d: array<vec2<f32>>,
}

@group(0) @binding(36) var<storage, read> cell_ranges: CellRanges;

// 0: some sample there may count.
fn empty_distance(so_far: Accumulator, cell: vec3<i32>) -> i32 {
    return i32(is_passed_over(so_far, cell_ranges.d[cell_index(cell)].y));
}
