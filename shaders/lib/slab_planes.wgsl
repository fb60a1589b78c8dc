// Slabs around the planes that a view-aligned slicer draws. CPU reference: src/lattice.rs.

#import slab
#import lattice_planes

fn slab_of(lattice: Lattice, world: Ray, k: i32) -> Slab {
    return plane_slab(world, vec2(lattice.t0, lattice.t1), k);
}
