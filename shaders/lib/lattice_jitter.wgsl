// Samples at equal steps, of which the first is cut short by a part that hangs on the pixel; each at the middle of
// what is left of its step. Twin: src/lattice.rs.

#import slab
#import jitter

struct Lattice {
    first: i32,
    count: i32,
    t0: f32,
    t1: f32,
    // Where the first step would begin.
    start: f32,
}

struct Segment {
    t: f32,
    length: f32,
}

fn lattice_of(world: Ray, interval: vec2<f32>, pixel: vec2<f32>) -> Lattice {
    let start = interval.x + (jitter_of(pixel) - 1.0) * frame.step_world;
    let full = floor((interval.y - start) / frame.step_world);
    return Lattice(0, i32(full) + 1, interval.x, interval.y, start);
}

// A segment of no length is outside.
fn segment_of(lattice: Lattice, world: Ray, k: i32) -> Segment {
    let slab = slab_of(lattice, world, k);
    return Segment(0.5 * (slab.front + slab.back), slab.length);
}

// Step k, cut to where the ray is in the domain.
fn slab_of(lattice: Lattice, world: Ray, k: i32) -> Slab {
    let enter = lattice.start + f32(k) * frame.step_world;
    let leave = lattice.start + f32(k + 1) * frame.step_world;
    let front = max(enter, lattice.t0);
    let back = min(leave, lattice.t1);
    let is_whole = front == enter && back == leave;
    return Slab(front, back, select(back - front, frame.step_world, is_whole));
}

// Which sample lies at t, as a fraction.
fn index_at(lattice: Lattice, world: Ray, t: f32) -> f32 {
    return (t - lattice.start) / frame.step_world - 0.5;
}
