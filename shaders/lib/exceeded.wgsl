// What cannot be a new extreme: a cell without values over the largest so far. Values count with their sign, so that a
// minimum is a maximum.

#import empty_space

struct CellRanges {
    // Smallest and largest value (shaders/macro_cells.wgsl).
    d: array<vec2<f32>>,
}

@group(0) @binding(36) var<storage, read> cell_ranges: CellRanges;

// 0: there may be a new extreme. Of equal ones the first counts.
fn empty_distance(so_far: Accumulator, cell: vec3<i32>) -> i32 {
    let range = frame.extreme_sign * cell_ranges.d[cell_index(cell)];
    let most = max(range.x, range.y);
    return i32(so_far.weight != 0.0 && most <= frame.extreme_sign * so_far.value);
}
