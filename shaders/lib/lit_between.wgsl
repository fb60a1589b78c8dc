// Light on what stands for a piece of a ray, a slab or a sample between slices: on the surface across the gradient in its
// middle. CPU reference: src/technique/shading.rs.

#import shade
#import {lamps=light}
#import gradient_of_{place=box}

// At a position in voxel space. A cut face, seen along no direction, has its own colour; without lights all light is
// ambient.
fn lit_at(color: vec3<f32>, voxel: vec3<f32>, ray_direction: vec3<f32>) -> vec3<f32> {
    if all(ray_direction == vec3(0.0)) {
        return color;
    }
    var gradient = vec3(0.0);
    if frame.light_count != 0u {
        gradient = gradient_in(voxel);
    }
    return shade(color, gradient, ray_direction, voxel);
}
