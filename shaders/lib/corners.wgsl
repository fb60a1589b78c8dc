// Trilinear from four words, each with the two ends of an edge of the cell between voxel centres, for devices whose sampler
// is a program: x first, then y, then z. What a word holds, filter_corners8.wgsl and filter_corners16.wgsl say. Twin:
// src/resident/corners.rs makes the words.

#import box
#import footprint_linear

// The words are folded into rows of this many.
const CORNERS_WIDTH: u32 = 8192u;

// Words lie in cubes of 4 x 4 x 4, x fastest inside of one and from one to the next.
@group(0) @binding(37) var corners: texture_storage_2d<r32uint, read>;

fn filtered(values: Values, coding: Coding, voxel: vec3<f32>) -> f32 {
    let last = frame.dims - 1.0;
    let place = clamp(voxel - 0.5, vec3(0.0), last);
    let below = vec3<u32>(place);
    let weight = place - vec3<f32>(below);
    let above = min(below.yz + 1u, vec2<u32>(last.yz));
    let row_words = 16u * ((word_of(u32(last.x)) + 4u) & ~3u);
    let layer_words = row_words * ((u32(frame.dims.y) + 3u) >> 2u);
    let column = word_of(below.x);
    let x = in_cube(column, 0u) + 16u * (column & ~3u);
    let low = x + in_cube(below.y, 2u) + row_words * (below.y >> 2u);
    let high = x + in_cube(above.x, 2u) + row_words * (above.x >> 2u);
    let front = in_cube(below.z, 4u) + layer_words * (below.z >> 2u);
    let back = in_cube(above.y, 4u) + layer_words * (above.y >> 2u);
    let edges = Edges(below.x, column, weight.x);
    let code = lerp(
        lerp(edge(edges, word(low + front)), edge(edges, word(high + front)), weight.y),
        lerp(edge(edges, word(low + back)), edge(edges, word(high + back)), weight.y),
        weight.z,
    );
    return value_from_code(coding, code + coding.offset);
}

// Where four edges along x begin, which word of its row that is in, and how far along them the sample lies.
struct Edges {
    voxel: u32,
    column: u32,
    weight: f32,
}

fn in_cube(word: u32, bit: u32) -> u32 {
    return (word & 3u) << bit;
}

fn word(index: u32) -> u32 {
    return textureLoad(corners, vec2(index % CORNERS_WIDTH, index / CORNERS_WIDTH)).x;
}
