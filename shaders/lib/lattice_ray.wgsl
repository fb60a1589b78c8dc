// Samples at equal steps from where the ray enters: t0 + (k + 1/2) h; the last, shorter segment is
// sampled at its own middle with its own length. Twin: src/lattice.rs.

#import ray

struct Lattice {
    first: i32,
    count: i32,
    t0: f32,
    t1: f32,
}

struct Segment {
    t: f32,
    length: f32,
}

fn lattice_of(world: Ray, interval: vec2<f32>, pixel: vec2<f32>) -> Lattice {
    let full = floor((interval.y - interval.x) / frame.step_world);
    return Lattice(0, i32(full) + 1, interval.x, interval.y);
}

// A segment of no length is outside.
fn segment_of(lattice: Lattice, world: Ray, k: i32) -> Segment {
    if k + 1 < lattice.count {
        return Segment(lattice.t0 + (f32(k) + 0.5) * frame.step_world, frame.step_world);
    }
    let start = lattice.t0 + f32(k) * frame.step_world;
    let length = max(lattice.t1 - start, 0.0);
    return Segment(start + 0.5 * length, length);
}

// Which sample lies at t, as a fraction.
fn index_at(lattice: Lattice, world: Ray, t: f32) -> f32 {
    return (t - lattice.t0) / frame.step_world - 0.5;
}
