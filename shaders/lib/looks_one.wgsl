// Each sample is taken by itself: there is so much to do at one that no way to memory is waited for.

fn walked(before: Reached, voxel: Ray, world: Ray, lattice: Lattice, walk: Walk) -> Reached {
    return Reached(before.so_far, skipped(before.so_far, walk, before.k));
}
