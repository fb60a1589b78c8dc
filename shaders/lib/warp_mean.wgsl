// The mean of four: premultiplied colour and alpha, sums along rays, what lies beside a picture.

struct WarpSum {
    sum: vec4<f32>,
}

fn warp_add(so_far: WarpSum, texel: vec4<f32>, weight: f32) -> WarpSum {
    return WarpSum(so_far.sum + weight * texel);
}

fn warp_end(found: WarpSum) -> vec4<f32> {
    return found.sum;
}
