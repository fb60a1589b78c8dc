// One sample for all of a run in a macro cell whose values look alike (shaders/distance_map.wgsl), with the opacity of
// all:
//
//     1 - (1 - a)^m = 1 - exp(-sigma m h)
//
// It is that in the middle of the run, a sample of the lattice. Runs of four cells at once: as in looks_alone.wgsl no
// way to memory hangs on the one before. What is empty is a run too, of which the one sample adds nothing. Twin:
// src/technique/march.rs (`march_in_runs`).

// From k up to `end` (excluded).
struct Run {
    k: i32,
    end: i32,
}

fn gathered(before: Accumulator, way: Way, start: i32) -> Accumulator {
    var so_far = before;
    var k = start;
    while k < min(way.walk.first, way.end) && !is_finished(so_far) {
        so_far = with_sample(so_far, way, k);
        k++;
    }
    let last = way.walk.end - 1;
    loop {
        k = after_nothing(way.walk, k);
        if k > last || is_finished(so_far) {
            break;
        }
        let first = run_of(way.walk, k);
        let second = run_of(way.walk, min(first.end, last));
        let third = run_of(way.walk, min(second.end, last));
        let fourth = run_of(way.walk, min(third.end, last));
        let seen_first = look(way, first);
        let seen_second = look(way, second);
        let seen_third = look(way, third);
        let seen_fourth = look(way, fourth);
        so_far = with_run(so_far, seen_first, true);
        so_far = with_run(so_far, seen_second, first.end <= last);
        so_far = with_run(so_far, seen_third, second.end <= last && first.end <= last);
        so_far = with_run(so_far, seen_fourth, third.end <= last && second.end <= last && first.end <= last);
        k = fourth.end;
    }
    while k < way.end && !is_finished(so_far) {
        so_far = with_sample(so_far, way, k);
        k++;
    }
    return so_far;
}

fn after_nothing(walk: Walk, start: i32) -> i32 {
    var k = start;
    loop {
        if !may_skip(walk, k) {
            break;
        }
        let cell = cell_of(walk, k);
        let room = room_of(cell);
        if room == 0 || room == i32(ROOM_ALIKE) {
            break;
        }
        k = after_room(walk, k, cell, room);
    }
    return k;
}

fn run_of(walk: Walk, k: i32) -> Run {
    // Where nothing is known, there are no cells: something stands in for them.
    let cell = max(cell_of(walk, k), vec3(0));
    let room = room_of(cell);
    let leaves = after_room(walk, k, cell, select(room, 1, room == i32(ROOM_ALIKE)));
    return Run(k, select(k + 1, min(leaves, walk.end), walk.is_known && room != 0));
}

// What a ray meets in a run.
struct Look {
    sample: Sample,
    segment: Segment,
}

fn look(way: Way, run: Run) -> Look {
    let count = run.end - run.k;
    var segment = whole_segment(way.lattice, way.world, run.k + (count - 1) / 2);
    segment.length *= f32(count);
    let position = way.voxel.origin + segment.t * way.voxel.direction;
    return Look(sample_at(position, way.world.direction), segment);
}

fn with_run(before: Accumulator, seen: Look, is_ours: bool) -> Accumulator {
    var so_far = before;
    let next = add(before, seen.sample, seen.segment);
    if is_ours && !is_finished(before) {
        so_far = next;
        so_far.samples += 1.0;
    }
    return so_far;
}
