// One number a sample, and where it was taken.

#import holes_{holes}

struct Sample {
    value: f32,
    voxel: vec3<f32>,
    // That of the pixel's ray, in world space, a unit vector.
    ray_direction: vec3<f32>,
}
