// Samples where the ray meets the planes that a view-aligned slicer draws, or the slices of a base plane. CPU reference:
// src/lattice.rs.

#import ray
#import lattice

// One plane more at each end: rounding may not lose one, and `segment_of` has the last word.
fn lattice_of(world: Ray, interval: vec2<f32>, pixel: vec2<f32>) -> Lattice {
    let origin = plane_height(world);
    let slope = dot(frame.forward, world.direction);
    let first = i32(floor((origin + interval.x * slope) / frame.step_world - 0.5));
    let last = i32(ceil((origin + interval.y * slope) / frame.step_world - 0.5));
    return Lattice(first, last - first + 1, interval.x, interval.y, interval.x);
}

// A segment of no length is outside.
fn segment_of(lattice: Lattice, world: Ray, k: i32) -> Segment {
    let t = plane_t(world, k);
    let inside = lattice.t0 <= t && t < lattice.t1;
    return Segment(t, select(0.0, plane_length(world), inside));
}

// One between two that lie inside.
fn whole_segment(lattice: Lattice, world: Ray, k: i32) -> Segment {
    return Segment(plane_t(world, k), plane_length(world));
}

// Samples lie at t = x + k y.
fn line_of(lattice: Lattice, world: Ray) -> vec2<f32> {
    return vec2(plane_t(world, 0), plane_length(world));
}

// From x (included) to y (excluded) none is cut short.
fn whole_samples(lattice: Lattice) -> vec2<i32> {
    return vec2(lattice.first, lattice.first + lattice.count);
}

// Which sample lies at t, as a fraction.
fn index_at(lattice: Lattice, world: Ray, t: f32) -> f32 {
    let height = plane_height(world) + t * dot(frame.forward, world.direction);
    return height / frame.step_world - 0.5;
}
