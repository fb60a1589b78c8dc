// Trilinear from two words, each the four voxels at the corners of a face of the cell between voxel centres, for devices
// whose sampler is a program: x first, then y, then z. Twin: src/resident/corners.rs makes the words.

#import box
#import footprint_linear

// The words are folded into rows of this many.
const CORNERS_WIDTH: u32 = 8192u;

// Of voxel (x, y, z) the codes of (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1), lowest byte first. Voxels lie in cubes
// of 4 x 4 x 4, x fastest inside of one and from one to the next.
@group(0) @binding(37) var corners: texture_storage_2d<r32uint, read>;

fn filtered(values: Values, coding: Coding, voxel: vec3<f32>) -> f32 {
    let last = frame.dims - 1.0;
    let place = clamp(voxel - 0.5, vec3(0.0), last);
    let below = vec3<u32>(place);
    let weight = place - vec3<f32>(below);
    let cubes = (vec2<u32>(frame.dims.xy) + 3u) >> vec2(2u);
    let row = in_cube(below.x, 0u) + in_cube(below.y, 2u) + 16u * ((below.x & ~3u) + cubes.x * (below.y & ~3u));
    let layer = 16u * cubes.x * cubes.y;
    let above = min(below.z + 1u, u32(last.z));
    let front = word(row + in_cube(below.z, 4u) + layer * (below.z & ~3u));
    let back = word(row + in_cube(above, 4u) + layer * (above & ~3u));
    let code = lerp(face(front, weight.xy), face(back, weight.xy), weight.z);
    return value_from_code(coding, code + coding.offset);
}

fn in_cube(voxel: u32, bit: u32) -> u32 {
    return (voxel & 3u) << bit;
}

fn word(index: u32) -> u32 {
    return textureLoad(corners, vec2(index % CORNERS_WIDTH, index / CORNERS_WIDTH)).x;
}

fn face(word: u32, weight: vec2<f32>) -> f32 {
    let left = vec2(f32(word & 255u), f32((word >> 16u) & 255u));
    let right = vec2(f32((word >> 8u) & 255u), f32(word >> 24u));
    let row = left + weight.x * (right - left);
    return lerp(row.x, row.y, weight.y);
}
