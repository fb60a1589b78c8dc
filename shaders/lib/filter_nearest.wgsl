// The value of the voxel that the position lies in.

#import nearest

fn footprint_of(voxel: vec3<f32>) -> Footprint {
    return nearest_footprint(voxel);
}

fn filtered(values: Values, coding: Coding, voxel: vec3<f32>) -> f32 {
    return nearest(values, coding, voxel);
}
