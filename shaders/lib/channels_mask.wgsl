// Channels of which some have voxels without a value.

#import holes_mask

// In the mask of a label map: there, and shadowed.
const DIMMED: u32 = 2u;

@group(0) @binding(11) var validity_1: Mask;
@group(0) @binding(12) var validity_2: Mask;
@group(0) @binding(13) var validity_3: Mask;

fn channel_has_data(channel: u32, place: Place) -> bool {
    if !is_in_channel(channel, place) {
        return false;
    }
    if frame.channel_has_holes[channel] == 0u {
        return true;
    }
    let footprint = channel_footprint(channel, place);
    switch channel {
        case 0u: { return volume_is_valid(footprint); }
        case 1u: { return all_valid(validity_1, footprint); }
        case 2u: { return all_valid(validity_2, footprint); }
        default: { return all_valid(validity_3, footprint); }
    }
}

// The same of a label map, whose values are those of single voxels: without a loop, which some drivers count.
fn label_is_there(channel: u32, place: Place) -> bool {
    return is_in_channel(channel, place)
        && (frame.channel_has_holes[channel] == 0u || label_mark(channel, place) != 0u);
}

// Labels lie in a channel after the first, where they have data.
fn channel_is_dimmed(channel: u32, place: Place) -> bool {
    return frame.channel_has_holes[channel] != 0u && channel != 0u && label_mark(channel, place) == DIMMED;
}

fn label_mark(channel: u32, place: Place) -> u32 {
    let footprint = channel_footprint(channel, place);
    switch channel {
        case 0u: { return mark_of(validity, footprint); }
        case 1u: { return mark_of(validity_1, footprint); }
        case 2u: { return mark_of(validity_2, footprint); }
        default: { return mark_of(validity_3, footprint); }
    }
}
