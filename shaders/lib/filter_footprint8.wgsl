// Corners of 8-bit voxels: a texel holds 4 x 4 of a plane, a row in each component, lowest byte first. The last row and
// the last column are the first of the next ones too.

#import footprint_texels

@group(0) @binding(37) var corners: texture_storage_2d<rgba32uint, read>;

// A third is a product and a shift, exact below 3 * 2^15: a division of whole numbers is a long way.
const THIRD: u32 = 43691u;
const THIRD_BITS: u32 = 17u;

// Which texel a voxel begins in, along x, and how far it lies in that.
fn in_texel(x: u32) -> vec2<u32> {
    let texel = (x * THIRD) >> THIRD_BITS;
    return vec2(texel, x - 3u * texel);
}

// The same along y.
fn in_row_of_texels(y: u32) -> vec2<u32> {
    return in_texel(y);
}

fn face_of(column: Along, row: Along, layer: u32) -> Face {
    let texel = textureLoad(corners, folded(column.first + row.first + layer));
    let low = select(select(texel.x, texel.y, row.inside == 1u), texel.z, row.inside == 2u);
    let high = select(select(texel.y, texel.z, row.inside == 1u), texel.w, row.inside == 2u);
    return Face(ends_in(low, 8u * column.inside), ends_in(high, 8u * column.inside));
}

fn ends_in(row: u32, shift: u32) -> vec2<f32> {
    let ends = row >> shift;
    // Of numbers with a sign, which this never is, processors make floats by one instruction.
    return vec2(f32(i32(ends & 255u)), f32(i32((ends >> 8u) & 255u)));
}
