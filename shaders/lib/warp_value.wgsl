// The mean of the values of those that have one: sum of w m v / sum of w m, m = 1 where there is one. What the others
// lack is missing in the weight, which the resolve multiplies alpha by.

struct WarpSum {
    // w m v, w m, nothing, w times the number of samples.
    sum: vec4<f32>,
}

fn warp_add(so_far: WarpSum, texel: vec4<f32>, weight: f32) -> WarpSum {
    return WarpSum(so_far.sum + weight * vec4(texel.x * texel.y, texel.y, 0.0, texel.w));
}

fn warp_end(found: WarpSum) -> vec4<f32> {
    let sum = found.sum;
    if sum.y == 0.0 {
        return vec4(0.0, 0.0, -1.0, sum.w);
    }
    return vec4(sum.x / sum.y, sum.y, -1.0, sum.w);
}
