// Numbers of the first choices of a path: points of Sobol's sequence in two dimensions, scrambled as Owen says, so that those of a
// pixel's paths fill the square evenly. Of n = 2^m points behind a multiple of n one lies in each box 2^-a x 2^-b, a + b = m.
//
//     i = scrambled(n)       x_j = bit j of i, from the binary point on       y_j = sum over k of (k over j) bit k of i, mod 2
//
// Pascal's triangle mod 2 is the product of five steps, one for each bit of k (Lucas). Scrambled (Owen 1995): each bit is turned by a
// hash of those before it, here by bits that only go up (Laine and Karras 2011), of the number with its bits turned round; so are
// the points of one pair of choices put in an order of their own (Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020).
// Two halves of the paths have sequences of their own: two pictures that know nothing of each other. CPU reference:
// src/technique/pathtrace/sobol.rs.

#import random

fn owen_scrambled(reversed: u32, seed: u32) -> u32 {
    var v = reversed + seed;
    v ^= v * 0x6c50b47cu;
    v ^= v * 0xb82f1e52u;
    v ^= v * 0xc7afe638u;
    return v ^ (v * 0x8d22f6e6u);
}

// How many paths in a row are of one half, as a power of two: few of the first ones.
fn paths_of_half(number: u32) -> u32 {
    return 1u + u32(number >= 8u) + u32(number >= 16u);
}

// Of pixel, path and seed of a key: two numbers from 0 (included) to 1 (excluded), multiples of 2^-24.
fn sobol_numbers(key: vec4<u32>, pair: u32) -> vec2<f32> {
    let bit = paths_of_half(key.y);
    let half = (key.y >> bit) & 1u;
    let number = ((key.y >> (bit + 1u)) << bit) | (key.y & ((1u << bit) - 1u));
    // No path has such a number.
    let seeds = pcg4d(vec4(key.x, 0xffffffffu - (2u * pair + half), 0u, key.w));
    let i = reverseBits(owen_scrambled(reverseBits(number), seeds.x));
    var y = i ^ ((i >> 16u) & 0x0000ffffu);
    y ^= (y >> 8u) & 0x00ff00ffu;
    y ^= (y >> 4u) & 0x0f0f0f0fu;
    y ^= (y >> 2u) & 0x33333333u;
    y ^= (y >> 1u) & 0x55555555u;
    let place = vec2(reverseBits(owen_scrambled(i, seeds.y)), reverseBits(owen_scrambled(y, seeds.z)));
    return vec2<f32>(place >> vec2(8u)) * (1.0 / 16777216.0);
}
