// Where the steps of a pixel's ray begin: a pattern in which neighbours are far apart, so that what is left of
// banding looks like fine grain. The sequence R2 of M. Roberts (2018) in whole numbers, parts of 2^32, the same on
// every device: multiples of 1/g and 1/g^2, g^3 = g + 1. Twin: src/lattice.rs.

#import frame

// Over 0, at most 1.
fn jitter_of(pixel: vec2<f32>) -> f32 {
    let place = vec2<u32>(pixel);
    let pattern = place.x * 3242174889u + place.y * 2447445414u + frame.jitter;
    return (f32(pattern >> 8u) + 0.5) / 16777216.0;
}
