// One sample for all of a run in a macro cell whose values look alike (shaders/distance_map.wgsl), with the opacity of
// all:
//
//     1 - (1 - a)^m = 1 - exp(-sigma m h)
//
// It is that in the middle of the run, a sample of the lattice. Runs of four cells at once: as in unroll_scalar.wgsl no
// way to memory depends on the one before. What is empty is a run too, of which the one sample adds nothing. CPU reference:
// src/technique/march.rs (`march_in_runs`).

// From k up to `end` (excluded).
struct Run {
    k: i32,
    end: i32,
}

fn gathered(before: Accumulator, segments: RaySegments, start: i32) -> Accumulator {
    var so_far = before;
    var k = start;
    while k < min(segments.line.first, segments.end) && !is_finished(so_far) {
        so_far = accumulate_sample(so_far, segments, k);
        k++;
    }
    let last = segments.line.end - 1;
    loop {
        k = after_nothing(segments.line, k);
        if k > last || is_finished(so_far) {
            break;
        }
        let first = run_of(segments.line, k);
        let second = run_of(segments.line, min(first.end, last));
        let third = run_of(segments.line, min(second.end, last));
        let fourth = run_of(segments.line, min(third.end, last));
        let seen_first = fetched(segments, first);
        let seen_second = fetched(segments, second);
        let seen_third = fetched(segments, third);
        let seen_fourth = fetched(segments, fourth);
        so_far = with_run(so_far, seen_first, true);
        so_far = with_run(so_far, seen_second, first.end <= last);
        so_far = with_run(so_far, seen_third, second.end <= last && first.end <= last);
        so_far = with_run(so_far, seen_fourth, third.end <= last && second.end <= last && first.end <= last);
        k = fourth.end;
    }
    while k < segments.end && !is_finished(so_far) {
        so_far = accumulate_sample(so_far, segments, k);
        k++;
    }
    return so_far;
}

fn after_nothing(line: SampleLine, start: i32) -> i32 {
    var k = start;
    loop {
        if !may_skip(line, k) {
            break;
        }
        let cell = cell_of(line, k);
        let distance = distance_to_occupied(cell);
        if distance == 0 || distance == i32(HOMOGENEOUS) {
            break;
        }
        k = first_sample_beyond(line, k, cell, distance);
    }
    return k;
}

fn run_of(line: SampleLine, k: i32) -> Run {
    // Where nothing is known, there are no cells: something stands in for them.
    let cell = max(cell_of(line, k), vec3(0));
    let distance = distance_to_occupied(cell);
    let leaves = first_sample_beyond(line, k, cell, select(distance, 1, distance == i32(HOMOGENEOUS)));
    return Run(k, select(k + 1, min(leaves, line.end), line.is_known && distance != 0));
}

// What a ray meets in a run.
struct SampleInFlight {
    sample: Sample,
    segment: Segment,
}

fn fetched(segments: RaySegments, run: Run) -> SampleInFlight {
    let count = run.end - run.k;
    var segment = whole_segment(segments.lattice, segments.world, run.k + (count - 1) / 2);
    segment.length *= f32(count);
    let position = segments.voxel.origin + segment.t * segments.voxel.direction;
    return SampleInFlight(sample_at(position, segments.world.direction), segment);
}

fn with_run(before: Accumulator, seen: SampleInFlight, is_ours: bool) -> Accumulator {
    var so_far = before;
    let next = add(before, seen.sample, seen.segment);
    if is_ours && !is_finished(before) {
        so_far = next;
        so_far.samples += 1.0;
    }
    return so_far;
}
