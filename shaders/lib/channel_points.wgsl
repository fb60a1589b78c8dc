// The control points of all channels in one list, one after the other.

#import transfer_points

fn classify_channel(channel: u32, value: f32) -> Classified {
    let color_first = frame.channel_point_first[channel];
    let color_count = frame.channel_color_point_count[channel];
    let opacity_count = frame.channel_opacity_point_count[channel];
    let is_step = frame.channel_interpolation_is_step[channel];
    let srgb = between_points(value, color_first, color_count, is_step).yzw;
    let opacity = between_points(value, color_first + color_count, opacity_count, is_step).y;
    return Classified(shown(srgb), extinction_of(opacity, frame.channel_reference_length[channel]));
}
