// A volume in which every voxel has a value.

fn volume_is_valid(footprint: Footprint) -> bool {
    return true;
}

fn voxel_is_valid(voxel: vec3<i32>) -> bool {
    return true;
}
