// Channels on the grid of the volume, the same bricks cut out of each.

#import colors_of_channels

fn value_in(values: Values, channel: u32, place: Place) -> f32 {
    // Nothing lies between two labels.
    if frame.channel_is_labels[channel] != 0u {
        return nearest(values, channel_coding(channel), place);
    }
    return filtered(values, channel_coding(channel), place);
}

fn channel_footprint(channel: u32, place: Place) -> Footprint {
    if frame.channel_is_labels[channel] != 0u {
        return nearest_footprint(place);
    }
    return footprint_of(place);
}

fn is_in_channel(channel: u32, place: Place) -> bool {
    return true;
}
