// Four whole slabs at once, between five ends: what is there depends on none before it, so that ways to memory overlap.
// Slabs that are cut short, and that of a cut face, come before and behind in loops of their own.

const SLABS_IN_FLIGHT: i32 = 4;

fn gathered(before: Accumulator, slabs: RaySlabs, start: i32) -> Accumulator {
    var so_far = before;
    var k = start;
    while k < min(slabs.line.first, slabs.end) && !is_finished(so_far) {
        so_far = with_slab(so_far, slab_at(slabs, k), true);
        k++;
    }
    // Behind the last slab it is looked at again, for nothing.
    let last = slabs.line.end - 1;
    let length = whole_length(slabs.world);
    loop {
        k = skipped(so_far, slabs.line, k);
        if k > last || is_finished(so_far) {
            break;
        }
        let ends = vec4(k, min(k + 1, last), min(k + 2, last), min(k + 3, last));
        let t0 = edge_of(slabs.lattice, slabs.world, k);
        let t1 = edge_of(slabs.lattice, slabs.world, ends.x + 1);
        let t2 = edge_of(slabs.lattice, slabs.world, ends.y + 1);
        let t3 = edge_of(slabs.lattice, slabs.world, ends.z + 1);
        let t4 = edge_of(slabs.lattice, slabs.world, ends.w + 1);
        let e0 = end_at(place_on(slabs, t0));
        let e1 = end_at(place_on(slabs, t1));
        let e2 = end_at(place_on(slabs, t2));
        let e3 = end_at(place_on(slabs, t3));
        let e4 = end_at(place_on(slabs, t4));
        so_far = with_slab(so_far, whole_slab(e0, e1, 0.5 * (t0 + t1), length), true);
        so_far = with_slab(so_far, whole_slab(e1, e2, 0.5 * (t1 + t2), length), k + 1 <= last);
        so_far = with_slab(so_far, whole_slab(e2, e3, 0.5 * (t2 + t3), length), k + 2 <= last);
        so_far = with_slab(so_far, whole_slab(e3, e4, 0.5 * (t3 + t4), length), k + 3 <= last);
        k = min(k + SLABS_IN_FLIGHT, slabs.line.end);
    }
    while k < slabs.end && !is_finished(so_far) {
        so_far = with_slab(so_far, slab_at(slabs, k), true);
        k++;
    }
    return so_far;
}

fn whole_slab(front: End, back: End, t: f32, length: f32) -> MetSlab {
    // Without light nobody asks for places and directions.
    let sample = Sample(front.value, back.value, vec3(0.0), vec3(0.0));
    return MetSlab(sample, Segment(t, length), front.is_valid && back.is_valid);
}

fn with_slab(before: Accumulator, slab: MetSlab, is_ours: bool) -> Accumulator {
    var so_far = before;
    let next = add(before, slab.sample, slab.segment);
    if is_ours && !is_finished(before) {
        if slab.has_data {
            so_far = next;
        }
        so_far.samples += 1.0;
    }
    return so_far;
}
