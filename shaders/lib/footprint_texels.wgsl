// Trilinear from the corners of two faces of the cell between voxel centres, for devices whose sampler is a program: x
// first, then y, then z. What a texel holds and how a face is read, filter_footprint8.wgsl and filter_footprint16.wgsl say.
// CPU reference: src/resident/footprint_texels.rs makes them.

#import box
#import footprint_linear

// The texels are folded into rows of this many.
const CORNERS_WIDTH: u32 = 8192u;

fn filtered(values: Values, coding: Coding, voxel: vec3<f32>) -> f32 {
    let last = frame.dims - 1.0;
    let place = clamp(voxel - 0.5, vec3(0.0), last);
    let below = vec3<u32>(place);
    let weight = place - vec3<f32>(below);
    let grid = grid_of_texels();
    let column = column_of(below.x);
    let row = row_of(grid, below.y);
    let front = face_of(column, row, layer_of(grid, below.z));
    let back = face_of(column, row, layer_of(grid, min(below.z + 1u, u32(last.z))));
    let code = lerp(in_face(front, weight.xy), in_face(back, weight.xy), weight.z);
    return value_from_code(coding, code + coding.offset);
}

// The corners of a face: two along x, at the lower y and at the upper one.
struct Face {
    low: vec2<f32>,
    high: vec2<f32>,
}

fn in_face(face: Face, weight: vec2<f32>) -> f32 {
    return lerp(lerp(face.low.x, face.low.y, weight.x), lerp(face.high.x, face.high.y, weight.x), weight.y);
}

// Texels lie in cubes of 4 x 4 x 4, z fastest inside of one, then x, and x fastest from one to the next: how many from
// one row of cubes to the next along y, and along z.
struct GridOfTexels {
    row: u32,
    layer: u32,
}

fn grid_of_texels() -> GridOfTexels {
    let last = vec2<u32>(frame.dims.xy) - 1u;
    let row = 16u * ((in_texel(last.x).x + 4u) & ~3u);
    return GridOfTexels(row, row * ((in_row_of_texels(last.y).x + 4u) >> 2u));
}

// A place along an axis: how far it lies in its texel, what it adds to where that is, and what the next voxel along y
// adds.
struct Along {
    inside: u32,
    first: u32,
    next: u32,
}

fn column_of(x: u32) -> Along {
    let column = in_texel(x);
    return Along(column.y, ((column.x & 3u) << 2u) + ((column.x & ~3u) << 4u), 0u);
}

fn row_of(grid: GridOfTexels, y: u32) -> Along {
    let row = in_row_of_texels(y);
    let next = in_row_of_texels(min(y + 1u, u32(frame.dims.y) - 1u));
    return Along(row.y, row_of_texels(grid, row.x), row_of_texels(grid, next.x));
}

fn row_of_texels(grid: GridOfTexels, row: u32) -> u32 {
    return ((row & 3u) << 4u) + grid.row * (row >> 2u);
}

fn layer_of(grid: GridOfTexels, z: u32) -> u32 {
    return (z & 3u) + grid.layer * (z >> 2u);
}

fn folded(index: u32) -> vec2<u32> {
    return vec2(index % CORNERS_WIDTH, index / CORNERS_WIDTH);
}
