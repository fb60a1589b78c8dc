// How far away the nearest cell with matter is, in cells (Chebyshev distance; Deakin and Knackstedt 2020), by four
// passes:
//
//     D0 = 0 where the transfer function shows any value of the cell, else REACH
//     D(x) = min over |k| < REACH of REACH and max(|k|, D before(x + k))        along x, then y, then z
//
// Farther than REACH counts as REACH: where nothing is for long, another leap costs a ray less than a longer search
// costs the map, which is made anew for each transfer function.
//
// Of several volumes in one place D0 is 0 where any of their functions shows one of their values.
//
// For steps that adapt (unroll_adaptive.wgsl) a fifth pass writes HOMOGENEOUS for 0 where the function hardly changes
// over the values of the cell, by a table of which values are alike in place of that of those that are seen.
//
// One thread a word, which has CELLS_PER_WORD cells along x: of D0 a bit each, set where matter is, so that D along x is
// counted in bits; of the others a byte each. Outside the grid is nothing. CPU reference: none, but pictures with it and without
// are the same.

#import cell_grid
#import distance_map_word

// Words of bits along x, and half of a word as it is.
const REACH: u32 = 16u;

struct CellRanges {
    d: array<vec2<f32>>,
}

struct Seen {
    // Value where entry 0 begins, and entries per value; of each entry the next that is seen.
    first: f32,
    scale: f32,
    count: u32,
    contour_count: u32,
    // Or the first that is not alike. Behind these, two words a contour: its value, and how far away a range shows it,
    // as a multiple of how wide that is.
    next: array<u32>,
}

struct DistanceMap {
    d: array<u32>,
}

struct Pass {
    // 0: what is seen. 1, 2, 3: along x, y, z. 4: what is seen of another volume too, after 0. 5: what is alike, after
    // 3.
    number: u32,
}

@group(0) @binding(31) var<storage, read> cell_ranges: CellRanges;
@group(0) @binding(32) var<storage, read> seen: Seen;
@group(0) @binding(33) var<storage, read> distances_before: DistanceMap;
@group(0) @binding(34) var<storage, read_write> distances_after: DistanceMap;
@group(0) @binding(35) var<uniform> which: Pass;

@compute @workgroup_size(4, 8, 2)
fn main(@builtin(global_invocation_id) place: vec3<u32>) {
    let words = vec3(words_along(cell_grid.cells), cell_grid.cells.yz);
    if any(place >= words) {
        return;
    }
    let own = distance_map_word(cell_grid.first, cell_grid.cells, place);
    switch which.number {
        case 0u, 4u: {
            let before = select(0u, distances_after.d[own], which.number == 4u);
            distances_after.d[own] = before | cells_seen(place);
        }
        case 1u: {
            distances_after.d[own] = packed(along_x(own, place.x, words.x));
        }
        case 5u: {
            distances_after.d[own] = packed(with_alike(place, distances_in(distances_after.d[own])));
        }
        default: {
            let is_z = which.number == 3u;
            let step = words.x * select(1u, words.y, is_z);
            let axis = select(1u, 2u, is_z);
            distances_after.d[own] = packed(along(own, step, place[axis], words[axis]));
        }
    }
}

// A bit for each cell of a word in which something is seen.
fn cells_seen(place: vec3<u32>) -> u32 {
    var bits = 0u;
    for (var i = 0u; i < CELLS_PER_WORD; i++) {
        let x = CELLS_PER_WORD * place.x + i;
        if x < cell_grid.cells.x {
            let range = cell_ranges.d[cell_index(vec3(x, place.yz))];
            bits |= u32(is_seen(range)) << i;
        }
    }
    return bits;
}

// Of bits, by how many cells lie between.
fn along_x(own: u32, at: u32, count: u32) -> vec4<u32> {
    var behind = distances_before.d[own] << REACH;
    var ahead = distances_before.d[own];
    for (var k = 1u; k <= REACH / CELLS_PER_WORD; k++) {
        if k <= at {
            behind |= distances_before.d[own - k] << (REACH - k * CELLS_PER_WORD);
        }
        if at + k < count {
            ahead |= distances_before.d[own + k] << (k * CELLS_PER_WORD);
        }
    }
    let cells = vec4(0u, 1u, 2u, 3u);
    let to_behind = countLeadingZeros(vec4(behind) << (vec4(31u - REACH) - cells));
    let to_ahead = countTrailingZeros(vec4(ahead) >> cells);
    return min(min(to_behind, to_ahead), vec4(REACH));
}

// Of bytes, along an axis of `count` cells, words `step` apart.
fn along(own: u32, step: u32, at: u32, count: u32) -> vec4<u32> {
    var nearest = distances_in(distances_before.d[own]);
    let behind = count - 1u - at;
    let reach = max(at, behind);
    for (var k = 1u; k <= reach && any(vec4(k) < nearest); k++) {
        if k <= at {
            nearest = min(nearest, max(vec4(k), distances_in(distances_before.d[own - k * step])));
        }
        if k <= behind {
            nearest = min(nearest, max(vec4(k), distances_in(distances_before.d[own + k * step])));
        }
    }
    return nearest;
}

fn with_alike(place: vec3<u32>, distances: vec4<u32>) -> vec4<u32> {
    var marked = distances;
    for (var i = 0u; i < CELLS_PER_WORD; i++) {
        let x = CELLS_PER_WORD * place.x + i;
        if x < cell_grid.cells.x && distances[i] == 0u {
            let range = cell_ranges.d[cell_index(vec3(x, place.yz))];
            marked[i] = select(0u, HOMOGENEOUS, is_alike(range));
        }
    }
    return marked;
}

// What f32 may lose on the way to a value, as a part of it.
const NEAR_ROUNDING: f32 = 1e-5;

// Whether a table shows any of these values, or a contour is near. CPU reference: src/transfer/visible_ranges.rs.
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
