// Order does not matter.

fn merged(before: vec4<f32>, batch: vec4<f32>) -> vec4<f32> {
    return before + batch;
}
