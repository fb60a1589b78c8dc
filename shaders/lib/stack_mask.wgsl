// A sample is no data when any voxel with a weight in it is: decided by fetches, never by filtering the mask.

#import stack
#import footprint

fn is_valid_at(mask: Mask, voxel: vec3<i32>) -> bool {
    let texel = texel_in_brick(voxel);
    return textureLoad(mask, texel.xy, texel.z, 0).x != 0u;
}

// What the mask says of the first voxel of a footprint.
fn mark_of(mask: Mask, footprint: Footprint) -> u32 {
    let texel = texel_of(footprint.min);
    return textureLoad(mask, texel.xy, texel.z, 0).x;
}

fn all_valid(mask: Mask, footprint: Footprint) -> bool {
    let low = texel_of(footprint.min);
    let high = texel_of(footprint.max);
    for (var y = low.y; y <= high.y; y++) {
        for (var x = low.x; x <= high.x; x++) {
            if textureLoad(mask, vec2(x, y), low.z, 0).x == 0u {
                return false;
            }
        }
    }
    return true;
}
