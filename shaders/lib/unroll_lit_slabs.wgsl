// Light is expensive, and only what is seen has any: each ray goes on to its next slab that shows something, in a loop of
// its own, and then those of all rays that are walked side by side are lit together.

fn gathered(before: Accumulator, slabs: RaySlabs, start: i32) -> Accumulator {
    var so_far = before;
    var k = start;
    loop {
        var slab = MetSlab(Sample(0.0, 0.0, vec3(0.0), vec3(0.0)), Segment(0.0, 0.0), false);
        var own = Classified(vec3(0.0), 0.0);
        var shows = false;
        loop {
            k = skipped(so_far, slabs.line, k);
            if k >= slabs.end || is_finished(so_far) {
                break;
            }
            slab = slab_at(slabs, k);
            own = classify_slab(slab.sample.front, slab.sample.back);
            so_far.samples += 1.0;
            // A cut face has its own colours.
            shows = slab.has_data & ((own.extinction != 0.0) | (k < slabs.first));
            k++;
            if shows {
                break;
            }
        }
        if !shows {
            break;
        }
        own.color = lit_at(own.color, slab.sample.middle, slab.sample.ray_direction);
        so_far = with_material(so_far, own, slab.sample.front, slab.segment);
    }
    return so_far;
}
