// Channels in which every voxel has a value.

#import holes_none

fn channel_has_data(channel: u32, place: Place) -> bool {
    return is_in_channel(channel, place);
}

fn channel_is_dimmed(channel: u32, place: Place) -> bool {
    return false;
}
