// Colours as they are.

fn lit_at(color: vec3<f32>, voxel: vec3<f32>, ray_direction: vec3<f32>) -> vec3<f32> {
    return color;
}
