// Channels in their own colours.

fn lit_channel(channel: u32, color: vec3<f32>, sample: Sample) -> vec3<f32> {
    return color;
}
