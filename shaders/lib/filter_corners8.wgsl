// Corners of 8-bit voxels: a texel holds 4 x 4 of a plane, a row in each component, lowest byte first. The last row and the
// last column are the first of the next ones too.

#import corners

// Which texel a row of voxels begins in, and which row of it that is.
fn row_in(y: u32) -> vec2<u32> {
    let texel = third_of(y);
    return vec2(texel, y - 3u * texel);
}

fn corners_in(texel: vec4<u32>, column: u32, row: u32) -> Face {
    let low = select(select(texel.x, texel.y, row == 1u), texel.z, row == 2u);
    let high = select(select(texel.y, texel.z, row == 1u), texel.w, row == 2u);
    return Face(ends_in(low, 8u * column), ends_in(high, 8u * column));
}

fn ends_in(row: u32, shift: u32) -> vec2<f32> {
    let ends = row >> shift;
    // Of numbers with a sign, which this never is, processors make floats by one instruction.
    return vec2(f32(i32(ends & 255u)), f32(i32((ends >> 8u) & 255u)));
}
