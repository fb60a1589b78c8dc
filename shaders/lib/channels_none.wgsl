// Channels in which every voxel has a value.

fn channel_has_data(channel: u32, place: Place) -> bool {
    return true;
}
