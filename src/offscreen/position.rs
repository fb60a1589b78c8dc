//! Where in the world the depths of a picture lie: eye or plane through it, plus depth along the ray.

use crate::scene::Scene;

/// Three numbers a pixel, in the file's world; NaN where there is no depth.
pub fn positions(scene: &Scene, depths: &[f32]) -> Vec<f32> {
    let rays = scene.camera.rays(scene.extent_pixels);
    let width = scene.extent_pixels[0] as usize;
    let at = |(i, &depth): (usize, &f32)| {
        let [x, y] = [i % width, i / width].map(|n| n as f64 + 0.5);
        let (origin, direction) = rays.at(x, y);
        let position = origin + f64::from(depth) * direction;
        position.as_vec3().to_array()
    };
    depths.iter().enumerate().flat_map(at).collect()
}
