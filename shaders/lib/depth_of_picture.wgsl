// Where a ray that composites has its depth: beside the picture. Negative: none.

fn depth_of(found: vec4<f32>) -> f32 {
    return found.y;
}
