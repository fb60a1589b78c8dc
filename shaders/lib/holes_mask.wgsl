// A volume in which some voxels have no value.

@group(0) @binding(3) var validity: Mask;

fn volume_is_valid(footprint: Footprint) -> bool {
    return all_valid(validity, footprint);
}

fn voxel_is_valid(voxel: vec3<i32>) -> bool {
    return is_valid_at(validity, voxel);
}
