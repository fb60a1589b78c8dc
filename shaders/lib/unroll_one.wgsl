// Each sample is taken by itself: there is so much to do at one that no way to memory is waited for.

fn gathered(before: Accumulator, segments: RaySegments, start: i32) -> Accumulator {
    var so_far = before;
    var k = start;
    loop {
        k = skipped(so_far, segments.line, k);
        if k >= segments.end || is_finished(so_far) {
            break;
        }
        so_far = accumulate_sample(so_far, segments, k);
        k++;
    }
    return so_far;
}
