// Colours as they are.

fn lit_color(color: vec3<f32>, sample: Sample) -> vec3<f32> {
    return color;
}
