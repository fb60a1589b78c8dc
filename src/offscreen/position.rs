//! What lies where the depths of a picture are: eye or plane through it, plus depth along the ray.

use crate::scene::{Beside, Scene};
use crate::technique::Role;
use crate::volume::{Volume, sample::nearest};
use glam::DVec3;

/// Three numbers a pixel, in the file's world; NaN where there is no depth.
pub fn positions(scene: &Scene, depths: &[f32]) -> Vec<f32> {
    let in_world = in_world(scene, depths);
    in_world.flat_map(|p| p.as_vec3().to_array()).collect()
}

/// The labels there; NaN where there is no depth or no label.
pub fn labels(scene: &Scene, depths: &[f32]) -> Vec<f32> {
    let Some(map) = label_map(scene) else {
        return vec![f32::NAN; depths.len()];
    };
    let voxel_from_world = map.world_from_voxel.inverse();
    let label_at = |p: DVec3| {
        let voxel = voxel_from_world.transform_point3(p);
        let label = (!voxel.is_nan()).then(|| nearest::<f64>(map, voxel.to_array()));
        label.flatten().map_or(f32::NAN, |label| label as f32)
    };
    in_world(scene, depths).map(label_at).collect()
}

/// The volume whose numbers are labels; one that is shown alone is taken for that where nothing mixes its numbers.
pub fn label_map<'a>(scene: &Scene<'a>) -> Option<&'a Volume> {
    match scene.beside {
        Beside::Nothing => Some(scene.volume).filter(|volume| !volume.is_outline()),
        Beside::Colors(_) | Beside::Classified(_) | Beside::Preclassified | Beside::Points(_) => {
            None
        }
        Beside::Channels(channels) => {
            let map = channels.iter().find(|one| one.role == Role::Labels);
            map.map(|map| map.volume)
        }
    }
}

/// The world positions of these depths; NaN where there is none.
pub fn in_world<'a>(scene: &'a Scene, depths: &'a [f32]) -> impl Iterator<Item = DVec3> + 'a {
    let rays = scene.camera.rays(scene.extent_pixels);
    let width = scene.extent_pixels[0] as usize;
    depths.iter().enumerate().map(move |(i, &depth)| {
        let [x, y] = [i % width, i / width].map(|n| n as f64 + 0.5);
        let (origin, direction) = rays.at(x, y);
        origin + f64::from(depth) * direction
    })
}
