// The largest extinction that the transfer function gives values of a macro cell: of bins of values, by a table of the maxima
// of 2^r bins beside each other (a sparse table: two look-ups for any range). CPU reference: src/technique/pathtrace/majorants.rs.

#import empty_space

struct CellRanges {
    d: array<vec2<f32>>,
}

@group(0) @binding(31) var<storage, read> cell_ranges: CellRanges;

// How far a value may lie from the bin that it is counted in: f32 rounds, and classification takes the nearest entry.
const BIN_SLACK: f32 = 0.0625;

fn majorant_of(cell: vec3<i32>) -> f32 {
    let range = cell_ranges.d[cell_index(cell)];
    let last = f32(MAJORANT_BINS - 1u);
    let bins = (range - frame.path_bin_first) * frame.path_bin_scale + vec2(-BIN_SLACK, BIN_SLACK);
    let ends = vec2<u32>(clamp(bins, vec2(0.0), vec2(last)));
    let row = firstLeadingBit(ends.y - ends.x + 1u);
    return max(largest_of(row, ends.x), largest_of(row, ends.y + 1u - (1u << row)));
}

fn largest_of(row: u32, bin: u32) -> f32 {
    let entry = row * MAJORANT_BINS + bin;
    return frame.path_majorants[entry / 4u][entry % 4u];
}
