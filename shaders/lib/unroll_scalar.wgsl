// Four whole samples at once: where each lies and what is there depends on none before it, so that their ways to memory
// overlap. Written out, because compilers do not unroll so much. Samples that are cut short, and that of a cut face,
// come before and behind in loops of their own: drivers on CPUs go through the body of a loop at least once.

const SAMPLES_IN_FLIGHT: i32 = 4;

// What a ray meets at a sample.
struct SampleInFlight {
    sample: Sample,
    segment: Segment,
    is_there: bool,
}

fn gathered(before: Accumulator, segments: RaySegments, start: i32) -> Accumulator {
    var so_far = before;
    var k = start;
    while k < min(segments.line.first, segments.end) && !is_finished(so_far) {
        so_far = accumulate_sample(so_far, segments, k);
        k++;
    }
    // Samples that the ray does not take any more are looked at for nothing, and behind the last one it is that again:
    // texels farther on may lie outside of a brick.
    let last = segments.line.end - 1;
    loop {
        k = skipped(so_far, segments.line, k);
        if k > last || is_finished(so_far) {
            break;
        }
        let first = fetched(segments, k);
        let second = fetched(segments, min(k + 1, last));
        let third = fetched(segments, min(k + 2, last));
        let fourth = fetched(segments, min(k + 3, last));
        so_far = with_sample(so_far, first, true);
        so_far = with_sample(so_far, second, k + 1 <= last);
        so_far = with_sample(so_far, third, k + 2 <= last);
        so_far = with_sample(so_far, fourth, k + 3 <= last);
        k = min(k + SAMPLES_IN_FLIGHT, segments.line.end);
    }
    while k < segments.end && !is_finished(so_far) {
        so_far = accumulate_sample(so_far, segments, k);
        k++;
    }
    return so_far;
}

fn fetched(segments: RaySegments, k: i32) -> SampleInFlight {
    let segment = whole_segment(segments.lattice, segments.world, k);
    let position = segments.voxel.origin + segment.t * segments.voxel.direction;
    return SampleInFlight(sample_at(position, segments.world.direction), segment, has_data(position));
}

fn with_sample(before: Accumulator, seen: SampleInFlight, is_ours: bool) -> Accumulator {
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
