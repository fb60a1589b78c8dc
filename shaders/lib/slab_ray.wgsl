// Slabs of one step each from where the steps begin; the last is shorter, and with jitter the first too.
// CPU reference: src/lattice.rs.

#import slab
#import lattice_ray

// Where slab k begins, unless it is cut short there; and how long one is that is not.
fn edge_of(lattice: Lattice, world: Ray, k: i32) -> f32 {
    return lattice.start + f32(k) * frame.step_world;
}

fn whole_length(world: Ray) -> f32 {
    return frame.step_world;
}

fn slab_of(lattice: Lattice, world: Ray, k: i32) -> Slab {
    let enter = lattice.start + f32(k) * frame.step_world;
    let is_last = k + 1 >= lattice.count;
    let front = max(enter, lattice.t0);
    let back = select(lattice.start + f32(k + 1) * frame.step_world, lattice.t1, is_last);
    let is_whole = !is_last && enter >= lattice.t0;
    return Slab(front, back, select(back - front, frame.step_world, is_whole));
}
