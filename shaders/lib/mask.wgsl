// A sample is no data when any voxel with a weight in it is: decided by fetches, never by filtering the mask.

#import box
#import footprint

fn all_valid(mask: Mask, footprint: Footprint) -> bool {
    for (var z = footprint.min.z; z <= footprint.max.z; z++) {
        for (var y = footprint.min.y; y <= footprint.max.y; y++) {
            for (var x = footprint.min.x; x <= footprint.max.x; x++) {
                if textureLoad(mask, vec3(x, y, z) - vec3<i32>(frame.brick_origin), 0).x == 0u {
                    return false;
                }
            }
        }
    }
    return true;
}
