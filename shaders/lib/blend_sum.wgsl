// For additive blending: sum of v d and sum of d.

fn blend_source(value: f32, length_world: f32) -> vec4<f32> {
    return vec4(value * length_world, length_world, 0.0, 0.0);
}
