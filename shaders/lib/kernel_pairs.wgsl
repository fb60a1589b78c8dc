// Two neighbours of positive weight by one linear fetch (Sigg and Hadwiger, GPU Gems 2, chapter 20, 2005): with
// taps i-1 .. i+2 of weights w0 .. w3,
//
//     w0 v[i-1] + w1 v[i]   = (w0 + w1) v(i-1 + w1 / (w0 + w1))
//     w2 v[i+1] + w3 v[i+2] = (w2 + w3) v(i+1 + w3 / (w2 + w3))
//
// where v(x) is linear between voxels. The two sums are 1 together. Not for Catmull-Rom, whose weights change sign.

#import kernel

// Voxel space positions of the two fetches of each axis, and the weight of the second.
struct Pairs {
    low: vec3<f32>,
    high: vec3<f32>,
    weight: vec3<f32>,
}

fn kernel_pairs(voxel: vec3<f32>) -> Pairs {
    let taps = kernel_taps(voxel);
    let w = taps.weights;
    let first = vec3<f32>(taps.first) + 0.5;
    let weight = w[2] + w[3];
    return Pairs(
        first + w[1] / (w[0] + w[1]),
        // Both are 0 where a quadratic is cut in the middle.
        first + 2.0 + w[3] / max(weight, vec3(1e-20)),
        weight,
    );
}
