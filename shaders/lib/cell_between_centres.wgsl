// Where filters are linear, cells lie between eight voxel centres.

#import cell_cubic
#import footprint

fn cell_begin() -> f32 {
    return 0.5;
}

// Along an axis on which a ray stays at voxel centres the upper corner has no weight.
fn taps_of(cell: vec3<i32>, stays: vec3<bool>) -> Footprint {
    let last = vec3<i32>(frame.dims) - 1;
    return Footprint(clamp(cell, vec3(0), last), clamp(select(cell + 1, cell, stays), vec3(0), last));
}

// How steep the field is along each axis.
fn cell_slope(corners: Corners, part: vec3<f32>) -> vec3<f32> {
    let along_x = corners.high - corners.low;
    let x = corners.low + part.x * along_x;
    return vec3(
        lerp(lerp(along_x.x, along_x.y, part.y), lerp(along_x.z, along_x.w, part.y), part.z),
        lerp(x.y - x.x, x.w - x.z, part.z),
        lerp(x.z - x.x, x.w - x.y, part.y),
    );
}
