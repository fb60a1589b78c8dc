// A volume in which every voxel has a value.

fn footprint_is_valid(footprint: Footprint) -> bool {
    return true;
}
