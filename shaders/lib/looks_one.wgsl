// One sample at once: there is enough to do at each.

const LOOKS_AT_ONCE: i32 = 1;

fn with_looks(before: Accumulator, voxel: Ray, world: Ray, lattice: Lattice, walk: Walk, k: i32) -> Accumulator {
    return with_look(before, look(voxel, world, lattice, k), true);
}
