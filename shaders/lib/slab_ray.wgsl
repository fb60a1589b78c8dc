// Slabs of one step each from where the ray enters; the last is shorter. Twin: src/lattice.rs.

#import slab
#import lattice_ray

fn slab_of(lattice: Lattice, world: Ray, k: i32) -> Slab {
    let front = lattice.t0 + f32(k) * frame.step_world;
    if k + 1 < lattice.count {
        return Slab(front, lattice.t0 + f32(k + 1) * frame.step_world, frame.step_world);
    }
    return Slab(front, lattice.t1, lattice.t1 - front);
}
