// Several volumes in one place: the volume is channel 0.

#import channels_{holes}
#import channels_on_{grids=shared}

@group(0) @binding(8) var channel_1: Values;
@group(0) @binding(9) var channel_2: Values;
@group(0) @binding(10) var channel_3: Values;

fn channel_value(channel: u32, place: Place) -> f32 {
    switch channel {
        case 0u: { return volume_value(place); }
        case 1u: { return value_in(channel_1, channel, place); }
        case 2u: { return value_in(channel_2, channel, place); }
        default: { return value_in(channel_3, channel, place); }
    }
}

fn channel_coding(channel: u32) -> Coding {
    return Coding(
        frame.channel_code_scale[channel],
        frame.channel_code_offset[channel],
        frame.channel_slope[channel],
        frame.channel_intercept[channel],
        frame.channel_codes_are_integers[channel],
    );
}

// True where the next channel says how opaque this one is.
fn is_opaque_by_next(channel: u32) -> bool {
    let next = channel + 1u;
    return next < frame.channel_count && frame.channel_is_opacity[next] != 0u;
}
