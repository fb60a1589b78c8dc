// Pre-integrated classification (Max, Hanrahan and Crawfis 1990; Engel, Kraus and Ertl 2001): the mean of emission
// and extinction between two values. With T and K their integrals over the value,
//
//     sigma = (T(sb) - T(sf)) / (sb - sf)        c = (K(sb) - K(sf)) / (T(sb) - T(sf))
//
// A mean over several cells is the part of the first, the whole ones between, and the part of the last: no
// digits are lost where values are close. CPU reference: src/transfer/slabs.rs.

#import frame
#import slab_part_{transfer=table}

// The table is folded into rows of this many texels, four a cell: mean, slope, sum, and what rounding took from it.
const SLAB_TABLE_WIDTH: i32 = 4096;
// Positions in the table end here: far beyond it, where f32 still can subtract.
const FARTHEST_CELL: f32 = 1e15;

struct Classified {
    color: vec3<f32>,
    extinction: f32,
}

fn classify_slab(front: f32, back: f32) -> Classified {
    let mean = mean_between(front, back);
    if mean.w <= 1.17549435e-38 {
        return Classified(vec3(0.0), 0.0);
    }
    return Classified(clamp(mean.xyz / mean.w, vec3(0.0), vec3(1.0)), mean.w);
}

// The mean of (emission, extinction).
fn mean_between(front: f32, back: f32) -> vec4<f32> {
    let low = slab_position(min(front, back));
    let high = slab_position(max(front, back));
    let first = slab_cell(low);
    let end = slab_cell(high);
    let in_first = low - f32(first);
    let in_last = high - f32(end);
    if first == end {
        let middle = 0.5 * (in_first + in_last) - 0.5;
        return slab_part(first, 0) + middle * slab_part(first, 1);
    }
    let of_first = slab_part(first, 0) + 0.5 * in_first * slab_part(first, 1);
    let of_last = slab_part(end, 0) + (0.5 * in_last - 0.5) * slab_part(end, 1);
    let whole = (slab_part(end, 2) - slab_part(first + 1, 2)) + (slab_part(end, 3) - slab_part(first + 1, 3));
    return ((1.0 - in_first) * of_first + whole + in_last * of_last) / (high - low);
}

// Where a value lies, in cells.
fn slab_position(value: f32) -> f32 {
    return clamp((value - frame.slab_first) * frame.slab_scale, -FARTHEST_CELL, FARTHEST_CELL);
}

fn slab_cell(position: f32) -> i32 {
    return i32(clamp(position, 0.0, f32(frame.slab_count - 1u)));
}
