/// Nothing but the invocation's place.
fn together(number: u32, lane: u32) -> vec4<u32> {
    return vec4(number, lane, 0u, 0u);
}
