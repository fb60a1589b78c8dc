// For additive blending: the number of samples.

fn blend_source(sample: Sample, length_world: f32) -> vec4<f32> {
    return vec4(1.0);
}
