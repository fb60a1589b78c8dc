// Channels of which some have voxels without a value.

#import holes_mask

@group(0) @binding(11) var validity_1: Mask;
@group(0) @binding(12) var validity_2: Mask;
@group(0) @binding(13) var validity_3: Mask;

fn channel_has_data(channel: u32, place: Place) -> bool {
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
