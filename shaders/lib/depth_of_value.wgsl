// Where a projected value has its depth. Negative: none.

fn depth_of(found: vec4<f32>) -> f32 {
    return found.z;
}
