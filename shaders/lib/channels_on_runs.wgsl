// Classified voxels as runs, of samples in the slices of a stack: of rows of voxels along x those alone are kept whose depth is
// over 0. Of each 32 voxels of a row there are a mask and the number of full voxels before them, so that the payload of voxel i has
//
//     rank = first + popcount(mask & (2^(i mod 32) - 1))
//
// Both lie in rows of 4096 texels: processors that run shaders fetch a texel sooner than a word of a buffer.
// Of a voxel that is not full all four numbers are 0. Bilinear inside the slice: along the lower axis first. CPU reference of the
// ranks: `RunBits::rank` (src/volume/runs/bits.rs); src/resident/classified_runs.rs makes them.

#import footprint

// Mask, and how many full voxels come before.
@group(0) @binding(50) var run_words: texture_2d<u32>;
// Red, green and blue times depth, and depth.
@group(0) @binding(51) var run_payload: texture_2d<f32>;

const RUN_WORD_VOXELS: u32 = 32u;
const RUN_TEXELS: u32 = 4096u;

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
    let above = lerp_color(classified_voxel(low), classified_voxel(right), part.x);
    let below = lerp_color(classified_voxel(down), classified_voxel(high), part.x);
    return lerp_color(above, below, part.y);
}

fn classified_voxel(voxel: vec3<i32>) -> vec4<f32> {
    let at = vec3<u32>(voxel);
    let dims = vec3<u32>(frame.dims);
    let words_of_row = (dims.x + RUN_WORD_VOXELS - 1u) / RUN_WORD_VOXELS;
    let number = at.x / RUN_WORD_VOXELS + words_of_row * (at.y + dims.y * at.z);
    let word = textureLoad(run_words, in_run_texels(number), 0).xy;
    let bit = 1u << (at.x % RUN_WORD_VOXELS);
    if (word.x & bit) == 0u {
        return vec4(0.0);
    }
    let rank = word.y + countOneBits(word.x & (bit - 1u));
    return textureLoad(run_payload, in_run_texels(rank), 0);
}

fn in_run_texels(number: u32) -> vec2<u32> {
    return vec2(number % RUN_TEXELS, number / RUN_TEXELS);
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
