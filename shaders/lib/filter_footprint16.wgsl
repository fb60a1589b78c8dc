// Corners of 16-bit voxels: a texel holds a voxel and, in its upper half, the next one in the row. A face as one texel
// of 16 bytes would take a third more memory, and was hardly faster (docs/log/performance.md).

#import footprint_texels

@group(0) @binding(37) var corners: texture_storage_2d<r32uint, read>;

// Which texel a voxel begins in, along x, and how far it lies in that.
fn in_texel(x: u32) -> vec2<u32> {
    return vec2(x, 0u);
}

// The same along y.
fn in_row_of_texels(y: u32) -> vec2<u32> {
    return vec2(y, 0u);
}

fn face_of(column: Along, row: Along, layer: u32) -> Face {
    return Face(ends_at(column.first + row.first + layer), ends_at(column.first + row.next + layer));
}

fn ends_at(index: u32) -> vec2<f32> {
    let ends = textureLoad(corners, folded(index)).x;
    // Of numbers with a sign, which this never is, processors make floats by one instruction.
    return vec2(f32(i32(ends & 0xffffu)), f32(i32(ends >> 16u)));
}
