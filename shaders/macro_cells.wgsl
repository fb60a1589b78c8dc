// Which values filters can make in a macro cell: smallest and largest of all voxels that a sample in it may touch, its
// own and a halo around them (without it, border samples would be called empty). Several threads a cell go along rows of
// texels beside each other.
// Where voxels have no value, what stands there counts, though no sample does.
// CPU reference: src/resident/cell_ranges.rs.

#import cell_grid
#import decode_{layout}

struct CellRanges {
    d: array<vec2<f32>>,
}

@group(0) @binding(31) var<storage, read_write> cell_ranges: CellRanges;

// Threads of a cell, and cells of a workgroup, beside each other along y.
const CELL_THREADS: u32 = 8u;
const CELLS: u32 = 8u;

// Least and most of what each thread has seen.
var<workgroup> seen: array<array<vec2<f32>, CELL_THREADS>, CELLS>;

@compute @workgroup_size(CELL_THREADS, CELLS)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_id) place: vec3<u32>) {
    let cell = vec3(id.x / CELL_THREADS, id.yz);
    let thread = i32(place.x);
    let own = cell_grid.origin + vec3<i32>(cell * CELL_VOXELS);
    let halo = vec3(cell_grid.halo);
    let low = max(own - halo, cell_grid.stored_min) - cell_grid.stored_min;
    let high = min(own + i32(CELL_VOXELS) - 1 + halo, cell_grid.stored_last) - cell_grid.stored_min;
    let size = max(high - low + 1, vec3(1));
    let is_cell = all(cell < cell_grid.cells);
    let rows = select(0, size.y * size.z, is_cell);
    var range = vec2(3.4e38, -3.4e38);
    for (var row = thread; row < rows; row += i32(CELL_THREADS)) {
        let first = low + vec3(0, row % size.y, row / size.y);
        for (var x = 0; x < size.x; x++) {
            range = both(range, vec2(decoded_at(first + vec3(x, 0, 0))));
        }
    }
    seen[place.y][thread] = range;
    workgroupBarrier();
    if thread > 0 || !is_cell {
        return;
    }
    for (var i = 1u; i < CELL_THREADS; i++) {
        range = both(range, seen[place.y][i]);
    }
    cell_ranges.d[cell_index(cell)] = range_of(range);
}

fn both(a: vec2<f32>, b: vec2<f32>) -> vec2<f32> {
    return vec2(min(a.x, b.x), max(a.y, b.y));
}

// The values that filters may make of codes between two ends.
fn range_of(codes: vec2<f32>) -> vec2<f32> {
    let ends = vec2(value_of(codes.x), value_of(codes.y));
    let range = vec2(min(ends.x, ends.y), max(ends.x, ends.y));
    let beyond = cell_grid.overshoot * 0.5 * (range.y - range.x) + cell_grid.slack
        + cell_grid.rounding * max(abs(range.x), abs(range.y));
    return range + vec2(-beyond, beyond);
}

fn value_of(texel: f32) -> f32 {
    let code = texel * cell_grid.code_scale;
    let exact = select(code, round(code), cell_grid.codes_are_integers != 0u) + cell_grid.code_offset;
    return exact * cell_grid.slope + cell_grid.intercept;
}
