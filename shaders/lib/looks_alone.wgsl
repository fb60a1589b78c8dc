// Four whole samples at once: where each lies and what is there hangs on none before it, so that their ways to memory
// overlap. Written out, because compilers do not unroll so much. Samples that are cut short, and that of a cut face,
// come before and behind in loops of their own: drivers on CPUs go through the body of a loop at least once.

const LOOKS_AT_ONCE: i32 = 4;

// What a ray meets at a sample.
struct Look {
    sample: Sample,
    segment: Segment,
    is_there: bool,
}

fn gathered(before: Accumulator, way: Way, start: i32) -> Accumulator {
    var so_far = before;
    var k = start;
    while k < min(way.walk.first, way.end) && !is_finished(so_far) {
        so_far = with_sample(so_far, way, k);
        k++;
    }
    // Samples that the ray does not take any more are looked at for nothing, and behind the last one it is that again:
    // texels farther on may lie outside of a brick.
    let last = way.walk.end - 1;
    loop {
        k = skipped(so_far, way.walk, k);
        if k > last || is_finished(so_far) {
            break;
        }
        let first = look(way, k);
        let second = look(way, min(k + 1, last));
        let third = look(way, min(k + 2, last));
        let fourth = look(way, min(k + 3, last));
        so_far = with_look(so_far, first, true);
        so_far = with_look(so_far, second, k + 1 <= last);
        so_far = with_look(so_far, third, k + 2 <= last);
        so_far = with_look(so_far, fourth, k + 3 <= last);
        k = min(k + LOOKS_AT_ONCE, way.walk.end);
    }
    while k < way.end && !is_finished(so_far) {
        so_far = with_sample(so_far, way, k);
        k++;
    }
    return so_far;
}

fn look(way: Way, k: i32) -> Look {
    let segment = whole_segment(way.lattice, way.world, k);
    let position = way.voxel.origin + segment.t * way.voxel.direction;
    return Look(sample_at(position, way.world.direction), segment, has_data(position));
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
