//! What a picture is added up of, and which layers it can have.

use super::Error;
use super::position::label_map;
use crate::picture::LayerKind;
use crate::scene::Scene;
use crate::technique::pathtrace::images_of;
use crate::technique::{Filter, Mode, SampleInputs, Settings};

/// Refuses layers that the picture of a scene does not have.
pub fn check_layers(scene: &Scene, wanted: &[LayerKind]) -> Result<(), Error> {
    let Settings {
        technique, mode, ..
    } = *scene.settings;
    let are_several = scene.mix() == SampleInputs::Channels;
    for &layer in wanted {
        if scene.settings.lack(layer, are_several).is_some() {
            return Err(Error::NoLayer {
                technique,
                mode,
                layer,
            });
        }
        if layer == LayerKind::Label && !has_labels(scene) {
            return Err(Error::NoLabels);
        }
        if layer == LayerKind::Normal && !has_normals(scene) {
            return Err(Error::NoNormals);
        }
    }
    Ok(())
}

/// True where some of the layers are left by paths beside their picture, and do not follow from its sums.
pub fn has_path_layers(wanted: &[LayerKind]) -> bool {
    wanted.iter().any(|&kind| !images_of(kind).is_empty())
}

/// True where a label can be told at the first hit: in a map over the volume, or in a volume of numbers that nothing
/// mixes.
pub fn has_labels(scene: &Scene) -> bool {
    let is_alone = scene.mix().is_of_one();
    label_map(scene).is_some() && (!is_alone || scene.settings.filter == Filter::Nearest)
}

/// True where the hit is one of the scene's volume, and its voxels are here.
pub fn has_normals(scene: &Scene) -> bool {
    let settings = scene.settings;
    let is_of_one = scene.mix().is_of_one() || settings.mode == Mode::Iso;
    // A path meets one of several.
    let has_one = is_of_one || settings.technique.traces_paths();
    has_one && !scene.volume.is_outline()
}

/// The mean of pictures, added up in f32 in the order of their rays: no device needs to blend for it.
pub struct Mean {
    weight: f32,
    pub pixels: Vec<[f32; 4]>,
}

impl Mean {
    pub fn new(per_side: u32) -> Self {
        Self {
            weight: 1.0 / (per_side * per_side) as f32,
            pixels: Vec::new(),
        }
    }

    /// The first picture's memory becomes that of the sum.
    pub fn add(&mut self, mut picture: Vec<[f32; 4]>) {
        let Self { weight, pixels } = self;
        let plus =
            |sum: [f32; 4], color: [f32; 4]| std::array::from_fn(|c| sum[c] + *weight * color[c]);
        if pixels.is_empty() {
            for pixel in &mut picture {
                *pixel = plus([0.0; 4], *pixel);
            }
            *pixels = picture;
            return;
        }
        for (sum, color) in pixels.iter_mut().zip(picture) {
            *sum = plus(*sum, color);
        }
    }
}

/// Milliseconds on the device so far.
pub struct Clock(pub Option<f64>);

impl Clock {
    pub fn add(&mut self, more: Option<f64>) {
        self.0 = self.0.zip(more).map(|(sum, more)| sum + more);
    }
}
