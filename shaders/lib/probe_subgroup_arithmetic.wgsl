/// Sums, of all and of those before, the largest, bits that are flipped.
fn together(number: u32, lane: u32) -> vec4<u32> {
    return vec4(subgroupAdd(number), subgroupExclusiveAdd(number), subgroupMax(number), subgroupXor(number));
}
