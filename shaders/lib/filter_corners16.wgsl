// Corners of 16-bit voxels: a word holds a voxel and, in its upper half, the next one in the row.

#import corners

fn word_of(voxel: u32) -> u32 {
    return voxel;
}

fn ends_of(edges: Edges, word: u32) -> vec2<f32> {
    // Of numbers with a sign, which this never is, processors make floats by one instruction.
    return vec2(f32(i32(word & 0xffffu)), f32(i32(word >> 16u)));
}
