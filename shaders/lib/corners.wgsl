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
    let grid = grid_of_words();
    let x = edges_of(below.x);
    let low = x.first + row_of(grid, below.y);
    let high = x.first + row_of(grid, above.x);
    let front = layer_of(grid, below.z);
    let back = layer_of(grid, above.y);
    let code = lerp(
        lerp(edge(x, low + front, weight.x), edge(x, high + front, weight.x), weight.y),
        lerp(edge(x, low + back, weight.x), edge(x, high + back, weight.x), weight.y),
        weight.z,
    );
    return value_from_code(coding, code + coding.offset);
}

// Words from one row of cubes to the next along y, and along z.
struct GridOfWords {
    row: u32,
    layer: u32,
}

fn grid_of_words() -> GridOfWords {
    let row = 16u * ((word_of(u32(frame.dims.x) - 1u) + 4u) & ~3u);
    return GridOfWords(row, row * ((u32(frame.dims.y) + 3u) >> 2u));
}

fn row_of(grid: GridOfWords, y: u32) -> u32 {
    return in_cube(y, 2u) + grid.row * (y >> 2u);
}

fn layer_of(grid: GridOfWords, z: u32) -> u32 {
    return in_cube(z, 4u) + grid.layer * (z >> 2u);
}

// Edges along x that begin at one voxel: which word of its row that is in, and how far that is from the row's beginning.
struct Edges {
    voxel: u32,
    column: u32,
    first: u32,
}

fn edges_of(voxel: u32) -> Edges {
    let column = word_of(voxel);
    return Edges(voxel, column, in_cube(column, 0u) + 16u * (column & ~3u));
}

// Between the ends of the edge in that word.
fn edge(edges: Edges, index: u32, weight: f32) -> f32 {
    let ends = ends_of(edges, word(index));
    return lerp(ends.x, ends.y, weight);
}

fn in_cube(word: u32, bit: u32) -> u32 {
    return (word & 3u) << bit;
}

fn word(index: u32) -> u32 {
    return textureLoad(corners, vec2(index % CORNERS_WIDTH, index / CORNERS_WIDTH)).x;
}
