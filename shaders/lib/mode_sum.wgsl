// The line integral, sum of v d, and the length it was taken over, sum of d: X-ray shows the first,
// average their quotient. CPU reference: src/technique/projection/reference.rs.

#import skip_nothing

struct Accumulator {
    value: f32,
    weight: f32,
    depth: f32,
    samples: f32,
}

fn begin() -> Accumulator {
    return Accumulator(0.0, 0.0, -1.0, 0.0);
}

fn add(so_far: Accumulator, value: f32, segment: Segment) -> Accumulator {
    return Accumulator(
        so_far.value + value * segment.length,
        so_far.weight + segment.length,
        so_far.depth,
        so_far.samples,
    );
}

fn is_finished(so_far: Accumulator) -> bool {
    return false;
}
