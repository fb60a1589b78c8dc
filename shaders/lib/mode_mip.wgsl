// Maximum of the values along the ray; of equal ones the first. CPU reference: src/technique/projection/reference.rs.

#import exceeded

struct Accumulator {
    value: f32,
    // Not 0 once a value is there.
    weight: f32,
    depth: f32,
    samples: f32,
}

fn begin() -> Accumulator {
    return Accumulator(0.0, 0.0, -1.0, 0.0);
}

fn add(so_far: Accumulator, value: f32, segment: Segment) -> Accumulator {
    if so_far.weight == 0.0 || value > so_far.value {
        return Accumulator(value, 1.0, segment.t, so_far.samples);
    }
    return so_far;
}

fn is_finished(so_far: Accumulator) -> bool {
    return false;
}
