// Classified voxels as runs, of samples in the slices of a stack: of rows of voxels along x those alone are kept whose depth is
// over 0. Of each 32 voxels of a row there are a mask and the number of full voxels before them, and the payload follows:
//
//     rank = first + popcount(mask & (2^(i mod 32) - 1))
//
// Of a voxel that is not full all four numbers are 0. Bilinear inside the slice: along the lower axis first. CPU reference of the
// ranks: `RunBits::rank` (src/volume/runs/bits.rs); src/resident/classified_runs.rs makes them.

#import footprint
#import run_payload_{transfer}

const RUN_WORD_VOXELS: u32 = 32u;

// Where the words and the payload lie.
struct RunGrid {
    words_of_row: u32,
    rows_of_slice: u32,
    payload: u32,
}

fn run_grid() -> RunGrid {
    let dims = vec3<u32>(frame.dims);
    let words_of_row = (dims.x + RUN_WORD_VOXELS - 1u) / RUN_WORD_VOXELS;
    return RunGrid(words_of_row, dims.y, 2u * words_of_row * dims.y * dims.z);
}

fn colors_at(place: Place) -> vec4<f32> {
    let axis = frame.slice_axis;
    let across = vec3<u32>(0u, 1u, 2u) == vec3(axis);
    // Heights of samples are those of slices, but for rounding.
    let slice = clamp(vec3<i32>(floor(place)), vec3(0), vec3<i32>(frame.dims) - 1);
    let taps = footprint_of(place);
    let low = select(taps.min, slice, across);
    let high = select(taps.max, slice, across);
    let weight = fract(place - 0.5);
    // Along the first of the two axes of the slice, and along the second.
    let right = select(vec3(high.x, low.yz), vec3(low.x, high.y, low.z), axis == 0u);
    let down = select(vec3(low.xy, high.z), vec3(low.x, high.y, low.z), axis == 2u);
    let part = vec2(select(weight.x, weight.y, axis == 0u), select(weight.z, weight.y, axis == 2u));
    let grid = run_grid();
    let above = lerp_color(classified_voxel(grid, low), classified_voxel(grid, right), part.x);
    let below = lerp_color(classified_voxel(grid, down), classified_voxel(grid, high), part.x);
    return lerp_color(above, below, part.y);
}

fn classified_voxel(grid: RunGrid, voxel: vec3<i32>) -> vec4<f32> {
    let at = vec3<u32>(voxel);
    let word = 2u * (at.x / RUN_WORD_VOXELS + grid.words_of_row * (at.y + grid.rows_of_slice * at.z));
    let mask = classified_runs.d[word];
    let bit = 1u << (at.x % RUN_WORD_VOXELS);
    if (mask & bit) == 0u {
        return vec4(0.0);
    }
    let rank = classified_runs.d[word + 1u] + countOneBits(mask & (bit - 1u));
    return run_payload(grid.payload, rank);
}

// As `lerp`, of four numbers.
fn lerp_color(a: vec4<f32>, b: vec4<f32>, part: f32) -> vec4<f32> {
    return a + part * (b - a);
}

fn value_in(values: Values, channel: u32, place: Place) -> f32 {
    return colors_at(place)[channel];
}

fn channel_footprint(channel: u32, place: Place) -> Footprint {
    return footprint_of(place);
}

fn is_in_channel(channel: u32, place: Place) -> bool {
    return true;
}
