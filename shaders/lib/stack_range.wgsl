// Which planes of a stack a ray may meet between two places, from front to back.

#import ray

struct StackRange {
    first: i32,
    // +1 or -1.
    step: i32,
    count: i32,
}

// Planes i lie at the height 1/2 + i; one more at both ends against rounding, and none outside of those from `lowest`
// to `highest`.
fn stack_range(start: f32, slope: f32, interval: vec2<f32>, lowest: i32, highest: i32) -> StackRange {
    let heights = start + interval * slope - 0.5;
    let low = clamp(i32(floor(min(heights.x, heights.y))), lowest, highest);
    let high = clamp(i32(ceil(max(heights.x, heights.y))), lowest, highest);
    return StackRange(select(high, low, slope > 0.0), select(-1, 1, slope > 0.0), high - low + 1);
}
