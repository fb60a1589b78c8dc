// The largest of the values that what lies before them fades, of equal ones the first, with u the value from 0
// to 1 and d the length that a sample stands for:
//
//     largest of u_k exp(-attenuation * sum of u_i d_i over i < k)
//
// As napari and vispy have it, but by world length, so that the number of samples does not count. CPU reference:
// src/technique/projection/reference.rs.

#import unit
#import passed_over

struct Accumulator {
    value: f32,
    // 0 before the first value, then 1 and the sum of u d.
    weight: f32,
    depth: f32,
    samples: f32,
}

fn begin() -> Accumulator {
    return Accumulator(0.0, 0.0, -1.0, 0.0);
}

fn add(so_far: Accumulator, value: f32, segment: Segment) -> Accumulator {
    let unit = unit_from_value(value);
    let before = max(so_far.weight - 1.0, 0.0);
    let faded = value_from_unit(unit * exp(-frame.attenuation * before));
    let weight = 1.0 + (before + unit * segment.length);
    if so_far.weight == 0.0 || faded > so_far.value {
        return Accumulator(faded, weight, segment.t, so_far.samples);
    }
    return Accumulator(so_far.value, weight, so_far.depth, so_far.samples);
}

// One less and one more is the same number up to here.
const EXACT: f32 = 16777216.0;

// What is 0 of 1 fades nothing, and is no larger than what has been met.
fn is_passed_over(so_far: Accumulator, most: f32) -> bool {
    let is_met = so_far.weight > 0.0 && so_far.weight < EXACT;
    return is_met && most <= frame.value_low;
}

fn is_finished(so_far: Accumulator) -> bool {
    return false;
}
