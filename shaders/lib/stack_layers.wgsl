// A stack's images: slice s of axis k is layer s, with axis (k + 1) mod 3 across and (k + 2) mod 3 down.

#import value

@group(0) @binding(1) var stack: texture_2d_array<f32>;

// Position inside a slice.
fn in_slice(voxel: vec3<f32>) -> vec2<f32> {
    return vec2(voxel[(frame.slice_axis + 1u) % 3u], voxel[(frame.slice_axis + 2u) % 3u]);
}
