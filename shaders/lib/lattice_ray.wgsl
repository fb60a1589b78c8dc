// Samples at equal steps from where the ray enters: t0 + (k + 1/2) h; the last, shorter segment is
// sampled at its own middle with its own length. Jittered rays begin by a part of a step earlier, which depends on the
// pixel, and their first segment is cut short in the same way. CPU reference: src/lattice.rs.

#import ray
#import lattice
#import start_{cuts=cut}

fn lattice_of(world: Ray, interval: vec2<f32>, pixel: vec2<f32>) -> Lattice {
    let start = start_of(interval, pixel);
    let full = floor((interval.y - start) / frame.step_world);
    return Lattice(0, i32(full) + 1, interval.x, interval.y, start);
}

// A segment of no length is outside.
fn segment_of(lattice: Lattice, world: Ray, k: i32) -> Segment {
    let enter = lattice.start + f32(k) * frame.step_world;
    let is_last = k + 1 >= lattice.count;
    if !is_last && enter >= lattice.t0 {
        return whole_segment(lattice, world, k);
    }
    let front = max(enter, lattice.t0);
    let back = select(lattice.start + f32(k + 1) * frame.step_world, lattice.t1, is_last);
    let length = max(back - front, 0.0);
    return Segment(front + 0.5 * length, length);
}

// One that is not cut short.
fn whole_segment(lattice: Lattice, world: Ray, k: i32) -> Segment {
    return Segment(lattice.start + (f32(k) + 0.5) * frame.step_world, frame.step_world);
}

// Samples lie at t = x + k y, but for those of the segments that are cut short.
fn line_of(lattice: Lattice, world: Ray) -> vec2<f32> {
    return vec2(lattice.start + 0.5 * frame.step_world, frame.step_world);
}

// From x (included) to y (excluded) none is: the first may be, the last is.
fn whole_samples(lattice: Lattice) -> vec2<i32> {
    return vec2(1, lattice.count - 1);
}

// Which sample lies at t, as a fraction.
fn index_at(lattice: Lattice, world: Ray, t: f32) -> f32 {
    return (t - lattice.start) / frame.step_world - 0.5;
}
