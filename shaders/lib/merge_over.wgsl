// The batch lies nearer to the eye.

fn merged(before: vec4<f32>, batch: vec4<f32>) -> vec4<f32> {
    return batch + (1.0 - batch.w) * before;
}
