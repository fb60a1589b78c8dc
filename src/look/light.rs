//! The light of pictures, where light shows a shape.
//!
//! ```text
//! light        right, up and towards the eye -0.5, 0.6, 1     ambient .35, diffuse .65, specular .2, shininess 20
//! g0           sqrt(3/2) sigma / h: the root mean square of the gradient that noise of deviation sigma makes, by central
//!              differences over voxels of the side h; of labels .01 / h: neighbours of two labels differ by 1 at least
//! ```

use super::values::summary;
use crate::technique::{Light, LightSpace, Shading};
use crate::transfer::Kind;
use crate::volume::{Volume, noise_of};
use glam::DVec3;

/// Material of lit pictures: ambient, diffuse and specular part, and shininess.
pub const MATERIAL: [f64; 4] = [0.35, 0.65, 0.2, 20.0];

/// The way to the light in the axes of the camera: from the left, above and behind it.
pub const LIGHT: DVec3 = DVec3::new(-0.5, 0.6, 1.0);

/// Samples for each voxel along a ray of a still: wood-grain of one sample a voxel is seen in smooth matter.
pub const STILL_SAMPLES: f64 = 2.0;

/// True for kinds of values whose surfaces light shows.
pub fn is_lit(kind: Kind) -> bool {
    matches!(kind, Kind::Ct | Kind::Tissue | Kind::Labels)
}

/// The half gradient of labels, in labels per voxel: their numbers have no noise, and a gradient of 1/2, the least between
/// two labels, has the weight .98.
const OF_LABELS: f64 = 0.01;

/// The half gradient that noise of a volume asks for, in values per world length.
pub fn half_gradient(volume: &Volume) -> f64 {
    let per_voxel = match summary(volume).labels {
        Some(_) => OF_LABELS,
        None => 1.5_f64.sqrt() * noise_of(volume),
    };
    per_voxel / volume.grid().smallest_spacing()
}

/// [`LIGHT`] on [`MATERIAL`], with the [`half_gradient`] of a volume.
pub fn light(volume: &Volume) -> Shading {
    let [ambient, diffuse, specular, shininess] = MATERIAL;
    Shading {
        ambient,
        diffuse,
        specular,
        shininess,
        half_gradient: half_gradient(volume),
        lights: vec![Light {
            towards: LIGHT,
            space: LightSpace::Camera,
            srgb: [1.0; 3],
        }],
        ..Shading::default()
    }
}
