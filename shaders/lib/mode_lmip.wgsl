// The first local maximum over the threshold (Sato et al. 1998): a maximum that ends where the values first
// fall from over the threshold. Up to there the largest value is the local maximum itself; a ray that never
// gets there ends as a MIP. Samples without data are passed over. CPU reference: src/technique/projection/reference.rs.

#import passed_over

struct Accumulator {
    value: f32,
    // 0 before the first value, 1 on the way, 2 past the local maximum.
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
    if value < so_far.value && so_far.value > frame.lmip_threshold {
        return Accumulator(so_far.value, 2.0, so_far.depth, so_far.samples);
    }
    return so_far;
}

// Under the threshold a value that is no new maximum ends nothing.
fn is_passed_over(so_far: Accumulator, most: f32) -> bool {
    return so_far.weight == 1.0 && so_far.value <= frame.lmip_threshold && most <= so_far.value;
}

fn is_finished(so_far: Accumulator) -> bool {
    return so_far.weight == 2.0;
}
