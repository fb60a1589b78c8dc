/// The numbers of neighbours.
fn together(number: u32, lane: u32) -> vec4<u32> {
    return vec4(subgroupShuffle(number, lane ^ 3u), subgroupShuffleXor(number, 1u), 0u, 0u);
}
