// Which values filters can make in a macro cell: smallest and largest of all voxels that a sample in it may touch, its
// own and an apron around them (`algorithms.md` 3: without, border samples would be called empty). One thread a cell.
// Where voxels have no value, what stands there counts, though no sample does.
// Twin: src/resident/cell_ranges.rs.

#import cell_grid
#import code_{layout}

struct CellRanges {
    d: array<vec2<f32>>,
}

@group(0) @binding(31) var<storage, read_write> cell_ranges: CellRanges;

@compute @workgroup_size(8, 4, 2)
fn main(@builtin(global_invocation_id) cell: vec3<u32>) {
    if any(cell >= cell_grid.cells) {
        return;
    }
    let own = cell_grid.origin + vec3<i32>(cell * CELL_VOXELS);
    let apron = vec3(cell_grid.apron);
    let low = max(own - apron, cell_grid.stored_min) - cell_grid.stored_min;
    let high = min(own + i32(CELL_VOXELS) - 1 + apron, cell_grid.stored_last) - cell_grid.stored_min;
    var least = 3.4e38;
    var most = -3.4e38;
    for (var z = low.z; z <= high.z; z++) {
        for (var y = low.y; y <= high.y; y++) {
            for (var x = low.x; x <= high.x; x++) {
                let texel = code_at(vec3(x, y, z));
                least = min(least, texel);
                most = max(most, texel);
            }
        }
    }
    let ends = vec2(value_of(least), value_of(most));
    let range = vec2(min(ends.x, ends.y), max(ends.x, ends.y));
    let beyond = cell_grid.overshoot * 0.5 * (range.y - range.x) + cell_grid.slack
        + cell_grid.rounding * max(abs(range.x), abs(range.y));
    cell_ranges.d[cell_index(cell)] = range + vec2(-beyond, beyond);
}

fn value_of(texel: f32) -> f32 {
    let code = texel * cell_grid.code_scale;
    let exact = select(code, round(code), cell_grid.codes_are_integers != 0u) + cell_grid.code_offset;
    return exact * cell_grid.slope + cell_grid.intercept;
}
