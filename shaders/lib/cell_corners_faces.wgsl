// The corners of a cell between voxel centres from two faces of footprint texels.

#import cell_between_centres
#import footprint_texels

fn cell_corners(taps: Footprint) -> Corners {
    let grid = grid_of_texels();
    let column = column_of(u32(taps.min.x));
    let row = row_of(grid, u32(taps.min.y));
    let held = taps.max == taps.min;
    let front = values_of(face_of(column, row, layer_of(grid, u32(taps.min.z))), held.xy);
    let back = values_of(face_of(column, row, layer_of(grid, u32(taps.max.z))), held.xy);
    return Corners(vec4(front.xz, back.xz), vec4(front.yw, back.yw));
}

// Of the lower row, then of the upper one; where the upper voxel is held, the lower one is it.
fn values_of(face: Face, held: vec2<bool>) -> vec4<f32> {
    let high = select(face.high, face.low, held.y);
    let codes = vec4(face.low, high);
    let coding = volume_coding();
    return (select(codes, codes.xxzz, held.x) + coding.offset) * coding.slope + coding.intercept;
}
