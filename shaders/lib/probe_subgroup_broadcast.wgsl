/// The numbers of the first and of the third.
fn together(number: u32, lane: u32) -> vec4<u32> {
    return vec4(subgroupBroadcastFirst(number), subgroupBroadcast(number, 2u), 0u, 0u);
}
