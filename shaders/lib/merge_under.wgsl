// The batch lies farther from the eye.

fn merged(before: vec4<f32>, batch: vec4<f32>) -> vec4<f32> {
    return before + (1.0 - before.w) * batch;
}
