// On to the next sample that may count, by what the mode says of the cells on the way (`empty_distance`): a loop of its
// own, so that rays that are walked side by side skip and sample together.

#import empty_space

fn skipped(so_far: Accumulator, line: SampleLine, start: i32) -> i32 {
    var k = start;
    loop {
        if !may_skip(line, k) {
            break;
        }
        let cell = cell_of(line, k);
        let distance = empty_distance(so_far, cell);
        if distance == 0 {
            break;
        }
        k = first_sample_beyond(line, k, cell, distance);
    }
    return k;
}
