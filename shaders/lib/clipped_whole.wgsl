// No clip plane: drivers that run the body of a loop once with nobody at work are spared that.

fn clipped(whole: vec2<f32>, origin: vec3<f32>, direction: vec3<f32>) -> vec2<f32> {
    return whole;
}
