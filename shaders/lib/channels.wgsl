// Several volumes on one grid, the same bricks cut out of each: the volume is channel 0.

#import channels_{holes}

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

fn value_in(values: Values, channel: u32, place: Place) -> f32 {
    let coding = Coding(
        frame.channel_code_scale[channel],
        frame.channel_code_offset[channel],
        frame.channel_slope[channel],
        frame.channel_intercept[channel],
        frame.channel_codes_are_integers[channel],
    );
    // Nothing lies between two labels.
    if frame.channel_is_labels[channel] != 0u {
        return nearest(values, coding, place);
    }
    return filtered(values, coding, place);
}

fn channel_footprint(channel: u32, place: Place) -> Footprint {
    if frame.channel_is_labels[channel] != 0u {
        return nearest_footprint(place);
    }
    return footprint_of(place);
}
