// The nearer slice.

#import between

fn nearer_slice(level: Level) -> i32 {
    let slices = slices_of(level);
    return select(slices.x, slices.y, level.part >= 0.5);
}

fn value_between(level: Level, voxel: vec3<f32>) -> f32 {
    return volume_value(Place(voxel, nearer_slice(level)));
}

fn has_data_between(level: Level, voxel: vec3<f32>) -> bool {
    return volume_is_valid(footprint_of(Place(voxel, nearer_slice(level))));
}
