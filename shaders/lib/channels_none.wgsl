// Channels in which every voxel has a value.

#import holes_none

fn channel_has_data(channel: u32, place: Place) -> bool {
    return is_in_channel(channel, place);
}

// The same of a label map, whose values are those of single voxels.
fn label_is_there(channel: u32, place: Place) -> bool {
    return is_in_channel(channel, place);
}

fn channel_is_dimmed(channel: u32, place: Place) -> bool {
    return false;
}
