//! Light, samples and background of `--look auto`.
//!
//! ```text
//! light        camera:-0.5,0.6,1    ambient .35, diffuse .65, specular .2, shininess 20
//! g0           sqrt(3/2) sigma / h: the root mean square of the gradient that noise of deviation sigma makes, by central
//!              differences over voxels of the side h
//! samples      2 a voxel in stills, 1 in films
//! ```

use super::BACKGROUND;
use crate::cli::flags::{
    Background, Classification, Depth, LightWord, ModeWord, Numbers, SceneFlags, ShadingWord,
    summary,
};
use crate::cli::shown::check;
use crate::transfer::{Context, Kind, Preset};
use crate::volume::{Volume, noise_of};
use glam::DVec3;

/// What pictures are made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Use {
    /// Frames of a film: many, and each seen for a moment.
    pub is_film: bool,
    /// The file has no other way to show what the picture lies on: PNG, films, windows.
    pub is_opaque: bool,
    /// How exactly they are kept.
    pub depth: Depth,
}

/// What light and samples are chosen by.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a> {
    /// Of a stream every n-th voxel.
    pub volume: &'a Volume,
    /// What its file says of the values.
    pub context: Option<&'a Context>,
    /// How its values are seen.
    pub classification: &'a Classification,
    /// Nothing is seen together with it.
    pub is_alone: bool,
}

/// Material of lit pictures: ambient, diffuse and specular part, and shininess.
const MATERIAL: [f64; 4] = [0.35, 0.65, 0.2, 20.0];

/// Where the light stands, in the axes of the camera: left, above, and behind it.
const LIGHT: DVec3 = DVec3::new(-0.5, 0.6, 1.0);

/// Samples for each voxel along a ray of a still: wood-grain of one sample a voxel is seen in smooth matter.
const STILL_SAMPLES: f64 = 2.0;

/// Presets that are made for lit surfaces.
const LIT_PRESETS: [Preset; 3] = [Preset::CtBone, Preset::CtSoftTissue, Preset::Mri];

/// The scene with light, samples and background where no flag says them.
pub fn with_light(scene: &SceneFlags, seen: Seen, made_for: Use) -> SceneFlags {
    let mut chosen = scene.clone();
    if !scene.is_auto() {
        return chosen;
    }
    if made_for.is_opaque {
        let background = Background::Color(BACKGROUND);
        chosen.picture.background.get_or_insert(background);
    }
    if !may_choose(scene) {
        return chosen;
    }
    let lit = lit(&chosen, seen);
    let is_drawable = |scene: &SceneFlags| {
        let settings = scene.settings(made_for.depth);
        settings.is_ok_and(|settings| check(scene, &settings).is_ok())
    };
    if let Some(lit) = lit.filter(is_drawable) {
        chosen = lit;
    }
    let sampling = &mut chosen.sampling;
    let is_plain = !sampling.preintegrated && sampling.adaptive_steps.is_none();
    if !made_for.is_film && is_plain && sampling.has_steps() {
        sampling.samples_per_voxel.get_or_insert(STILL_SAMPLES);
    }
    chosen
}

/// True for composites whose function the program has chosen, or is made for light.
fn may_choose(scene: &SceneFlags) -> bool {
    let is_composite = matches!(scene.sampling.mode, None | Some(ModeWord::Composite));
    let classification = &scene.classification;
    let preset = classification.preset.as_deref().and_then(Preset::from_name);
    is_composite
        && scene.section.section.is_none()
        && classification.transfer_function.is_none()
        && preset.is_none_or(|preset| LIT_PRESETS.contains(&preset))
}

/// The lit scene, where light shows a shape.
fn lit(scene: &SceneFlags, seen: Seen) -> Option<SceneFlags> {
    let light = &scene.light;
    if !seen.is_alone || light.shading == Some(ShadingWord::None) || light.shadows.is_some() {
        return None;
    }
    let volume = seen.volume;
    let is_named = scene.classification.preset.is_some();
    let Classification::Function(function) = seen.classification else {
        return None;
    };
    let has_shape = || {
        let summary = summary(volume);
        let kind = match seen.context {
            Some(context) => context.choice(&summary).kind,
            None => Kind::of(&summary),
        };
        matches!(kind, Kind::Ct | Kind::Tissue | Kind::Labels)
    };
    if function.is_graded() || !is_named && !has_shape() {
        return None;
    }
    let mut lit = scene.clone();
    let light = &mut lit.light;
    light.shading = Some(ShadingWord::Phong);
    light.material.get_or_insert(Numbers(MATERIAL));
    if light.light.is_empty() {
        light.light.push(LightWord::of_camera(LIGHT));
    }
    let noise_gradient = 1.5_f64.sqrt() * noise_of(volume) / volume.grid().smallest_spacing();
    light.half_gradient.get_or_insert(noise_gradient);
    Some(lit)
}
