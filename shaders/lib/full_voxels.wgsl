// Which voxels matter, by themselves: a structure that knows of single voxels, where macro cells know of 8^3
// (src/resident/full_voxels.rs).

#import empty_space

struct FullVoxels {
    // Voxels along x, y, z, then what the structure says of itself.
    nx: u32,
    ny: u32,
    nz: u32,
    d: array<u32>,
}

@group(0) @binding(46) var<storage, read> full_voxels: FullVoxels;

fn voxels_along() -> vec3<u32> {
    return vec3(full_voxels.nx, full_voxels.ny, full_voxels.nz);
}

// The voxel that sample k lies in.
fn voxel_of_sample(line: SampleLine, k: i32) -> vec3<u32> {
    let place = f32(CELL_VOXELS) * (line.at + f32(k) * line.step);
    return vec3<u32>(clamp(place, vec3(0.0), vec3<f32>(voxels_along() - 1u)));
}

// The first sample that lies outside of a box of voxels around sample k, `end` beside it.
fn first_sample_beyond_box(line: SampleLine, k: i32, first: vec3<u32>, end: vec3<u32>) -> i32 {
    let planes = select(first, end, line.step > vec3(0.0));
    return first_sample_past(line, k, vec3<f32>(planes) / f32(CELL_VOXELS));
}
