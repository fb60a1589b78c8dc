// A sample is no data when any voxel with a weight in it is: decided by fetches, never by filtering the mask.

#import box
#import footprint

fn all_valid(mask: Mask, footprint: Footprint) -> bool {
    let low = footprint.min - vec3<i32>(frame.brick_origin);
    let high = footprint.max - vec3<i32>(frame.brick_origin);
    for (var z = low.z; z <= high.z; z++) {
        for (var y = low.y; y <= high.y; y++) {
            if !row_is_valid(mask, low.x, high.x, y, z) {
                return false;
            }
        }
    }
    return true;
}

fn is_valid_at(mask: Mask, voxel: vec3<i32>) -> bool {
    return valid_at(mask, texel_in_brick(voxel)) != 0u;
}

// A row has at most four voxels: no loop, because some drivers count the turns of all loops (`src/technique/loop_limit.rs`).
fn row_is_valid(mask: Mask, low: i32, high: i32, y: i32, z: i32) -> bool {
    let ends = min(valid_at(mask, vec3(low, y, z)), valid_at(mask, vec3(high, y, z)));
    if high - low < 2 {
        return ends != 0u;
    }
    return min(ends, min(valid_at(mask, vec3(low + 1, y, z)), valid_at(mask, vec3(high - 1, y, z)))) != 0u;
}

// What the mask says of the first voxel of a footprint.
fn mark_of(mask: Mask, footprint: Footprint) -> u32 {
    return valid_at(mask, footprint.min - vec3<i32>(frame.brick_origin));
}

fn valid_at(mask: Mask, texel: vec3<i32>) -> u32 {
    return textureLoad(mask, texel, 0).x;
}
