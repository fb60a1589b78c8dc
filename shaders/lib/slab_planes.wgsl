// Slabs around the planes that a view-aligned slicer draws. CPU reference: src/lattice.rs.

#import slab
#import lattice_planes

// Where slab k begins, unless it is cut short there; and how long one is that is not.
fn edge_of(lattice: Lattice, world: Ray, k: i32) -> f32 {
    return edge_t(world, k);
}

fn whole_length(world: Ray) -> f32 {
    return plane_length(world);
}

fn slab_of(lattice: Lattice, world: Ray, k: i32) -> Slab {
    return plane_slab(world, vec2(lattice.t0, lattice.t1), k);
}
