// Four samples at once: where each lies and what is there hangs on none before it, so that their ways to memory overlap.
// Written out, because compilers do not unroll so much. Samples that the ray does not take any more are looked at for
// nothing, and behind the last one it is that again: texels farther on may lie outside of a brick.

const LOOKS_AT_ONCE: i32 = 4;

fn with_looks(before: Accumulator, voxel: Ray, world: Ray, lattice: Lattice, walk: Walk, k: i32) -> Accumulator {
    let last = walk.end - 1;
    let first = look(voxel, world, lattice, k);
    let second = look(voxel, world, lattice, min(k + 1, last));
    let third = look(voxel, world, lattice, min(k + 2, last));
    let fourth = look(voxel, world, lattice, min(k + 3, last));
    var so_far = with_look(before, first, true);
    so_far = with_look(so_far, second, k + 1 <= last);
    so_far = with_look(so_far, third, k + 2 <= last);
    return with_look(so_far, fourth, k + 3 <= last);
}
