// Light that nothing takes away.

fn ambient_at(voxel: vec3<f32>, ray_direction: vec3<f32>) -> f32 {
    return 1.0;
}

fn lamp_at(lamp: u32, voxel: vec3<f32>) -> f32 {
    return 1.0;
}
