// (1 - a) of the slice below and a of the slice above.

#import between

fn value_between(level: Level, voxel: vec3<f32>) -> f32 {
    let slices = slices_of(level);
    let below = volume_value(Place(voxel, slices.x));
    if level.part == 0.0 || slices.x == slices.y {
        return below;
    }
    return lerp(below, volume_value(Place(voxel, slices.y)), level.part);
}

fn has_data_between(level: Level, voxel: vec3<f32>) -> bool {
    let slices = slices_of(level);
    if !volume_is_valid(footprint_of(Place(voxel, slices.x))) {
        return false;
    }
    return level.part == 0.0 || volume_is_valid(footprint_of(Place(voxel, slices.y)));
}
