// Where the steps of a pixel's ray begin: a pattern in which neighbours are far apart, so that what is left of
// banding looks like fine grain. Blue noise by void and cluster (Ulichney 1993; shaders/blue_noise.rs), numbers r of
// n^2 on a torus, the same on every device:
//
//     u = frac((r + 1/2) / n^2 + jitter)        part = 1 - |2 u - 1|
//
// frac alone would put beside each other what lies near 0 and near 1, which are apart in the pattern, and the noise
// would no longer be blue; folded it stays so, and as even from picture to picture as the jitters are. CPU reference:
// src/blue_noise.rs.

#import frame

const BLUE_NOISE_SIDE: u32 = 64u;

@group(0) @binding(38) var blue_noise: texture_2d<u32>;

// Over 0, at most 1.
fn jitter_of(pixel: vec2<f32>) -> f32 {
    let place = (vec2<u32>(pixel) + frame.jitter_shift) % vec2(BLUE_NOISE_SIDE);
    let rank = textureLoad(blue_noise, place, 0).x;
    // In parts of 2^32, of which the ranks fill the first 12 bits.
    let part = (rank << 20u) + (1u << 19u) + frame.jitter;
    let folded = select(part << 1u, ~(part << 1u), part >= 0x80000000u);
    return (f32(folded >> 8u) + 0.5) / 16777216.0;
}
