// A volume in which every voxel has a value.

fn volume_is_valid(footprint: Footprint) -> bool {
    return true;
}
