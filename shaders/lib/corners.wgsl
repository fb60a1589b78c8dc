// Trilinear from two texels, each with the four corners of a face of the cell between voxel centres, for devices whose
// sampler is a program: x first, then y, then z. What a texel holds, filter_corners8.wgsl and filter_corners16.wgsl say.
// Twin: src/resident/corners.rs makes them.

#import box
#import footprint_linear

// The texels are folded into rows of this many.
const CORNERS_WIDTH: u32 = 8192u;
// New voxels along x. A third is a product and a shift, exact below 3 * 2^15: a division of whole numbers is a long way.
const TEXEL_COLUMNS: u32 = 3u;
const THIRD: u32 = 43691u;
const THIRD_BITS: u32 = 17u;

// Texels lie in cubes of 4 x 4 x 4, z fastest inside of one, then x, and x fastest from one to the next.
@group(0) @binding(37) var corners: texture_storage_2d<rgba32uint, read>;

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

// Texels from one row of cubes to the next along y, and along z.
struct GridOfTexels {
    row: u32,
    layer: u32,
}

fn grid_of_texels() -> GridOfTexels {
    let last = vec2<u32>(frame.dims.xy) - 1u;
    let row = 16u * ((third_of(last.x) + 4u) & ~3u);
    return GridOfTexels(row, row * ((row_in(last.y).x + 4u) >> 2u));
}

// A place along an axis: how far it lies in its texel, and what it adds to where that is.
struct Along {
    inside: u32,
    first: u32,
}

fn column_of(x: u32) -> Along {
    let texel = third_of(x);
    return Along(x - TEXEL_COLUMNS * texel, ((texel & 3u) << 2u) + ((texel & ~3u) << 4u));
}

fn row_of(grid: GridOfTexels, y: u32) -> Along {
    let row = row_in(y);
    return Along(row.y, ((row.x & 3u) << 4u) + grid.row * (row.x >> 2u));
}

fn layer_of(grid: GridOfTexels, z: u32) -> u32 {
    return (z & 3u) + grid.layer * (z >> 2u);
}

fn third_of(voxel: u32) -> u32 {
    return (voxel * THIRD) >> THIRD_BITS;
}

fn face_of(column: Along, row: Along, layer: u32) -> Face {
    let index = column.first + row.first + layer;
    return corners_in(textureLoad(corners, vec2(index % CORNERS_WIDTH, index / CORNERS_WIDTH)), column.inside, row.inside);
}
