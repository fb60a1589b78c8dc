// The corners of a cell between voxel centres from eight texels.

#import cell_between_centres
#import box

fn cell_corners(taps: Footprint) -> Corners {
    let a = taps.min;
    let b = taps.max;
    return Corners(
        vec4(
            corner(vec3(a.x, a.y, a.z)),
            corner(vec3(a.x, b.y, a.z)),
            corner(vec3(a.x, a.y, b.z)),
            corner(vec3(a.x, b.y, b.z)),
        ),
        vec4(
            corner(vec3(b.x, a.y, a.z)),
            corner(vec3(b.x, b.y, a.z)),
            corner(vec3(b.x, a.y, b.z)),
            corner(vec3(b.x, b.y, b.z)),
        ),
    );
}

fn corner(voxel: vec3<i32>) -> f32 {
    let coding = volume_coding();
    return value_from_code(coding, code_from_texel(coding, texel_at(volume, voxel).x));
}
