// Four whole samples at once: where each lies and what is there hangs on none before it, so that their ways to memory
// overlap. Written out, because compilers do not unroll so much.

const LOOKS_AT_ONCE: i32 = 4;

// What a ray meets at a sample.
struct Look {
    sample: Sample,
    segment: Segment,
    is_there: bool,
}

fn walked(before: Reached, voxel: Ray, world: Ray, lattice: Lattice, walk: Walk) -> Reached {
    var so_far = before.so_far;
    var k = before.k;
    // Samples that the ray does not take any more are looked at for nothing, and behind the last one it is that again:
    // texels farther on may lie outside of a brick.
    let last = walk.end - 1;
    loop {
        k = skipped(so_far, walk, k);
        if k < walk.first || k > last || is_finished(so_far) {
            break;
        }
        let first = look(voxel, world, lattice, k);
        let second = look(voxel, world, lattice, min(k + 1, last));
        let third = look(voxel, world, lattice, min(k + 2, last));
        let fourth = look(voxel, world, lattice, min(k + 3, last));
        so_far = with_look(so_far, first, true);
        so_far = with_look(so_far, second, k + 1 <= last);
        so_far = with_look(so_far, third, k + 2 <= last);
        so_far = with_look(so_far, fourth, k + 3 <= last);
        k = min(k + LOOKS_AT_ONCE, walk.end);
    }
    return Reached(so_far, k);
}

fn look(voxel: Ray, world: Ray, lattice: Lattice, k: i32) -> Look {
    let segment = whole_segment(lattice, world, k);
    let position = voxel.origin + segment.t * voxel.direction;
    return Look(sample_at(position, world.direction), segment, has_data(position));
}

fn with_look(before: Accumulator, seen: Look, is_ours: bool) -> Accumulator {
    var so_far = before;
    let next = add(before, seen.sample, seen.segment);
    if is_ours && !is_finished(before) {
        if seen.is_there {
            so_far = next;
        }
        so_far.samples += 1.0;
    }
    return so_far;
}
