// Where filters do not mix, cells are those of voxels, of one value, and surfaces are their faces.

#import cell_cubic
#import nearest

fn cell_begin() -> f32 {
    return 0.0;
}

fn taps_of(cell: vec3<i32>, stays: vec3<bool>) -> Footprint {
    let voxel = clamp(cell, vec3(0), vec3<i32>(frame.dims) - 1);
    return Footprint(voxel, voxel);
}

fn cell_corners(taps: Footprint) -> Corners {
    let value = vec4(nearest(volume, volume_coding(), vec3<f32>(taps.min) + 0.5));
    return Corners(value, value);
}

fn cell_slope(corners: Corners, part: vec3<f32>) -> vec3<f32> {
    return vec3(0.0);
}
