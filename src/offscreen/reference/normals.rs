//! Unit normals where the depths of a picture are:
//!
//! ```text
//! normal = -gradient / |gradient|        towards lower values, in the file's world
//! ```
//!
//! Made on the host for pictures of devices too: no shader keeps a gradient beside the picture.

use super::{filtered, gradient_at, moved};
use crate::offscreen::position::in_world;
use crate::scene::Scene;
use crate::technique::{Error, GradientSource, InPixel};
use crate::volume::Coefficients;
use glam::DVec3;

/// Three numbers a pixel; NaN where there is no depth, no data around, or no gradient. Of rays.
///
/// # Errors
/// Those of the parameters.
pub fn normals(scene: &Scene, depths: &[f32]) -> Result<Vec<f32>, Error> {
    let (settings, volume, grid) = (scene.settings, scene.volume, scene.volume.grid());
    let frame = scene.view(&grid, InPixel::CENTER).on_cpu()?.frame;
    let coefficients = |spline| Coefficients::new(volume, spline, [true; 3]);
    let of_values = settings.filter.spline().map(coefficients);
    let of_values = of_values.as_ref().map_or(volume, Coefficients::volume);
    let source = settings.gradient_source();
    let of_gradients = source.and_then(GradientSource::spline).map(coefficients);
    let of_gradients = of_gradients.as_ref().map_or(volume, Coefficients::volume);
    let weighted = source.map(|_| (of_gradients, settings.gradient_operator()));
    let voxel_from_world = volume.world_from_voxel.inverse();
    let normal_at = |world: DVec3| {
        if world.is_nan() {
            return [f32::NAN; 3];
        }
        let p = voxel_from_world.transform_point3(world).to_array();
        let value_at = |step| filtered(of_values, settings.filter, moved(p, step));
        let gradient = DVec3::from(gradient_at::<f64>(&frame, weighted, p, value_at));
        let normal = (-gradient).try_normalize();
        normal.map_or([f32::NAN; 3], |normal| normal.as_vec3().to_array())
    };
    Ok(in_world(scene, depths).flat_map(normal_at).collect())
}
