// Red, green and blue of a sample, and what the fourth channel says where there is one.

fn colors_at(place: Place) -> vec4<f32> {
    let color = vec3(channel_value(0u, place), channel_value(1u, place), channel_value(2u, place));
    if frame.channel_count == 3u {
        return vec4(color, 0.0);
    }
    return vec4(color, channel_value(3u, place));
}
