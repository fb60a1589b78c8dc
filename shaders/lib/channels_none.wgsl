// Channels in which every voxel has a value.

#import holes_none

fn channel_has_data(channel: u32, place: Place) -> bool {
    return true;
}

fn channel_is_dimmed(channel: u32, place: Place) -> bool {
    return false;
}
