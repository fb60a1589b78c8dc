// Each sample is taken by itself: there is so much to do at one that no way to memory is waited for.

fn gathered(before: Accumulator, way: Way, start: i32) -> Accumulator {
    var so_far = before;
    var k = start;
    loop {
        k = skipped(so_far, way.walk, k);
        if k >= way.end || is_finished(so_far) {
            break;
        }
        so_far = with_sample(so_far, way, k);
        k++;
    }
    return so_far;
}
