// How far away the nearest cell with matter is, in cells (Chebyshev distance; Deakin and Knackstedt 2020), by four
// passes:
//
//     D0 = 0 where the transfer function shows any value of the cell, else REACH
//     D(x) = min over |k| < REACH of REACH and max(|k|, D before(x + k))        along x, then y, then z
//
// Farther than REACH counts as REACH: where nothing is for long, another leap costs a ray less than a longer search costs
// the map, which is made anew for each transfer function.
//
// Of several volumes in one place D0 is 0 where any of their functions shows one of their values.
//
// For steps that adapt (looks_adaptive.wgsl) a fifth pass writes ALIKE for 0 where the function hardly changes over the
// values of the cell, by a table of which values are alike in place of that of those that are seen.
//
// Outside the grid is nothing. One thread a cell. Twin: none, but pictures with it and without are the same.

#import cell_grid

const REACH: u32 = 16u;
const ALIKE: u32 = 0x40000000u;

struct CellRanges {
    d: array<vec2<f32>>,
}

struct Seen {
    // Value where entry 0 begins, and entries per value; of each entry the next that is seen.
    first: f32,
    scale: f32,
    count: u32,
    contour_count: u32,
    // Or the first that is not alike. Behind these, two words a contour: its value, and how far away a range shows it, as a
    // multiple of how wide that is.
    next: array<u32>,
}

struct Rooms {
    d: array<u32>,
}

struct Pass {
    // 0: what is seen. 1, 2, 3: along x, y, z. 4: what is seen of another volume too, after 0. 5: what is alike, after 3.
    number: u32,
}

@group(0) @binding(31) var<storage, read> cell_ranges: CellRanges;
@group(0) @binding(32) var<storage, read> seen: Seen;
@group(0) @binding(33) var<storage, read> rooms_before: Rooms;
@group(0) @binding(34) var<storage, read_write> rooms_after: Rooms;
@group(0) @binding(35) var<uniform> which: Pass;

@compute @workgroup_size(8, 4, 2)
fn main(@builtin(global_invocation_id) cell: vec3<u32>) {
    if any(cell >= cell_grid.cells) {
        return;
    }
    let own = cell_index(cell);
    if which.number == 0u {
        rooms_after.d[own] = select(REACH, 0u, is_seen(cell_ranges.d[own]));
        return;
    }
    if which.number == 4u {
        if is_seen(cell_ranges.d[own]) {
            rooms_after.d[own] = 0u;
        }
        return;
    }
    if which.number == 5u {
        if rooms_after.d[own] == 0u && is_alike(cell_ranges.d[own]) {
            rooms_after.d[own] = ALIKE;
        }
        return;
    }
    let axis = which.number - 1u;
    var step = 1u;
    if axis > 0u {
        step *= cell_grid.cells.x;
    }
    if axis > 1u {
        step *= cell_grid.cells.y;
    }
    let before = cell[axis];
    let behind = cell_grid.cells[axis] - 1u - before;
    let reach = max(before, behind);
    // At most REACH.
    var nearest = rooms_before.d[own];
    for (var k = 1u; k <= reach && k < nearest; k++) {
        if k <= before {
            nearest = min(nearest, max(k, rooms_before.d[own - k * step]));
        }
        if k <= behind {
            nearest = min(nearest, max(k, rooms_before.d[own + k * step]));
        }
    }
    rooms_after.d[own] = nearest;
}

// What f32 may lose on the way to a value, as a part of it.
const NEAR_ROUNDING: f32 = 1e-5;

// Whether a table shows any of these values, or a contour is near. Twin: src/transfer/seen.rs.
fn is_seen(range: vec2<f32>) -> bool {
    let entries = entries_of(range);
    var is_shown = seen.next[entries.x] <= entries.y;
    for (var i = 0u; i < seen.contour_count; i++) {
        let value = bitcast<f32>(seen.next[seen.count + 2u * i]);
        let reach = bitcast<f32>(seen.next[seen.count + 2u * i + 1u]);
        let away = max(max(range.x - value, value - range.y), 0.0);
        is_shown = is_shown || away <= reach * (range.y - range.x) + NEAR_ROUNDING * abs(value);
    }
    return is_shown;
}

fn is_alike(range: vec2<f32>) -> bool {
    let entries = entries_of(range);
    return seen.next[entries.x] > entries.y;
}

// The first and the last. One more on both sides: f32 rounds on the way to an entry.
fn entries_of(range: vec2<f32>) -> vec2<u32> {
    let last = f32(seen.count - 1u);
    let from_entry = u32(clamp(floor((range.x - seen.first) * seen.scale) - 1.0, 0.0, last));
    let to_entry = u32(clamp(floor((range.y - seen.first) * seen.scale) + 1.0, 0.0, last));
    return vec2(from_entry, to_entry);
}
