// Trilinear from two words, each the four voxels at the corners of a face of the cell between voxel centres, for devices
// whose sampler is a program: x first, then y, then z. Twin: src/resident/corners.rs makes the words.

#import box
#import footprint_linear

struct Corners {
    // Of voxel (x, y, z) the codes of (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1), lowest byte first.
    d: array<u32>,
}

@group(0) @binding(37) var<storage, read> corners: Corners;

fn filtered(values: Values, coding: Coding, voxel: vec3<f32>) -> f32 {
    let last = frame.dims - 1.0;
    let place = clamp(voxel - 0.5, vec3(0.0), last);
    let below = vec3<u32>(place);
    let weight = place - vec3<f32>(below);
    let size = vec3<u32>(frame.dims);
    let front = below.x + size.x * (below.y + size.y * below.z);
    let back = front + select(0u, size.x * size.y, below.z + 1u < size.z);
    let code = lerp(face(corners.d[front], weight.xy), face(corners.d[back], weight.xy), weight.z);
    return value_from_code(coding, code + coding.offset);
}

fn face(word: u32, weight: vec2<f32>) -> f32 {
    let left = vec2(f32(word & 255u), f32((word >> 16u) & 255u));
    let right = vec2(f32((word >> 8u) & 255u), f32(word >> 24u));
    let row = left + weight.x * (right - left);
    return lerp(row.x, row.y, weight.y);
}
