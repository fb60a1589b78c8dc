// A volume in which some voxels have no value.

@group(0) @binding(3) var validity: Mask;

fn volume_is_valid(footprint: Footprint) -> bool {
    return all_valid(validity, footprint);
}
