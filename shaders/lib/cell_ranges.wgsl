// What values a macro cell may have (shaders/macro_cells.wgsl).

#import empty_space

struct CellRanges {
    d: array<vec2<f32>>,
}

@group(0) @binding(36) var<storage, read> cell_ranges: CellRanges;

// Smallest and largest.
fn range_of(cell: vec3<i32>) -> vec2<f32> {
    return cell_ranges.d[cell_index(cell)];
}
