// Samples of a ray.

struct Lattice {
    first: i32,
    count: i32,
    // Where the ray is in the domain.
    t0: f32,
    t1: f32,
    // Where the first step begins: t0 without jitter.
    start: f32,
}

struct Segment {
    t: f32,
    length: f32,
}
