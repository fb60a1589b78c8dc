// Light is expensive, and only what is seen has any: each ray goes on to its next sample that shows something, in a loop of
// its own, and then those of all rays that are walked side by side are lit together. What lies between adds nothing and
// is counted.

fn gathered(before: Accumulator, segments: RaySegments, start: i32) -> Accumulator {
    var so_far = before;
    var k = start;
    loop {
        var found = Met(Sample(0.0, vec3(0.0), vec3(0.0)), Segment(0.0, 0.0), false);
        loop {
            k = skipped(so_far, segments.line, k);
            if k >= segments.end || is_finished(so_far) {
                break;
            }
            found = met(segments, k);
            so_far.samples += 1.0;
            k++;
            if found.shows {
                break;
            }
        }
        if !found.shows {
            break;
        }
        so_far = add(so_far, found.sample, found.segment);
    }
    return so_far;
}

struct Met {
    sample: Sample,
    segment: Segment,
    shows: bool,
}

// Sample k, which shows nothing where there is no data, and where its value is transparent and sends out no light. A cut face
// has its own colours.
fn met(segments: RaySegments, k: i32) -> Met {
    let segment = segment_at(segments, k);
    let sample = sample_in(segments, k, segment);
    let shines = (frame.emission_point_count != 0u) | (k < segments.first);
    let shows = (classify(sample.value).extinction != 0.0) | shines;
    return Met(sample, segment, shows & has_data(position_in(segments, segment)));
}
