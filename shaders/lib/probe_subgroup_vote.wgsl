/// Whether all have, and whether any has, a number of four bits or more, and of one or more.
fn together(number: u32, lane: u32) -> vec4<u32> {
    return vec4(
        u32(subgroupAll(number >= 8u)),
        u32(subgroupAny(number >= 8u)),
        u32(subgroupAll(number >= 1u)),
        u32(subgroupAny(number < 1u)),
    );
}
