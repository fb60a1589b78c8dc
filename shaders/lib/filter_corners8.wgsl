// Corners of 8-bit voxels: a word holds four neighbours in a row, lowest byte first, the last of which the next word has too.

#import corners

// New voxels a word. A third is a product and a shift, exact below 3 * 2^15: a division of whole numbers is a long way.
const VOXELS_A_WORD: u32 = 3u;
const THIRD: u32 = 43691u;
const THIRD_BITS: u32 = 17u;

fn word_of(voxel: u32) -> u32 {
    return (voxel * THIRD) >> THIRD_BITS;
}

fn ends_of(edges: Edges, word: u32) -> vec2<f32> {
    let ends = word >> (8u * (edges.voxel - VOXELS_A_WORD * edges.column));
    // Of numbers with a sign, which this never is, processors make floats by one instruction.
    return vec2(f32(i32(ends & 255u)), f32(i32((ends >> 8u) & 255u)));
}
