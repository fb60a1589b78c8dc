// Corners of 16-bit voxels: a texel holds 4 x 2 of a plane, a row in two components, lower half first. The upper row and the
// last column are the first of the next ones too.

#import corners

// Which texel a row of voxels begins in, and which row of it that is.
fn row_in(y: u32) -> vec2<u32> {
    return vec2(y, 0u);
}

fn corners_in(texel: vec4<u32>, column: u32, row: u32) -> Face {
    return Face(ends_in(texel.xy, column), ends_in(texel.zw, column));
}

fn ends_in(row: vec2<u32>, column: u32) -> vec2<f32> {
    let middle = (row.x >> 16u) | (row.y << 16u);
    let ends = select(select(row.x, middle, column == 1u), row.y, column == 2u);
    // Of numbers with a sign, which this never is, processors make floats by one instruction.
    return vec2(f32(i32(ends & 0xffffu)), f32(i32(ends >> 16u)));
}
