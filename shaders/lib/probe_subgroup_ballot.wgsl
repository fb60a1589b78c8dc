/// A bit for each that has an odd number.
fn together(number: u32, lane: u32) -> vec4<u32> {
    return subgroupBallot((number & 1u) == 1u);
}
