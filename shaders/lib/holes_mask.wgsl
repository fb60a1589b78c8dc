// A volume in which some voxels have no value; beside others it may be one that has all of them.

@group(0) @binding(3) var validity: Mask;

fn volume_is_valid(footprint: Footprint) -> bool {
    return frame.channel_has_holes[0] == 0u || all_valid(validity, footprint);
}

fn voxel_is_valid(voxel: vec3<i32>) -> bool {
    return is_valid_at(validity, voxel);
}
