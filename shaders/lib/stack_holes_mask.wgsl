// A sample is no data when any voxel with a weight in it is: decided by fetches, never by filtering the mask.

#import stack_layers

@group(0) @binding(3) var validity: texture_2d_array<u32>;

fn footprint_is_valid(footprint: Footprint) -> bool {
    let low = texel_of(footprint.min);
    let high = texel_of(footprint.max);
    for (var y = low.y; y <= high.y; y++) {
        for (var x = low.x; x <= high.x; x++) {
            if textureLoad(validity, vec2(x, y), low.z, 0).x == 0u {
                return false;
            }
        }
    }
    return true;
}
