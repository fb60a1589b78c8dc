//! Light, samples and background of `--look auto`.
//!
//! Two samples a voxel in stills, one in films and of several volumes that are lit.

use crate::cli::flags::{
    Background, Classification, Depth, LightWord, Numbers, SceneFlags, ShadingWord,
};
use crate::cli::scene_inputs::check;
use crate::look::{
    BACKGROUND, LIGHT, MATERIAL, Origin, STILL_SAMPLES, half_gradient, is_lit, may_choose, summary,
};
use crate::shaders::MAX_LIGHTS;
use crate::technique::Mode;
use crate::transfer::{Context, Kind, Preset};
use crate::volume::Volume;

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
    /// It is seen together with labels or with volumes that stand by themselves, which light shows the shape of.
    pub is_beside_others: bool,
}

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
    let Some(mode) = mode(scene).filter(|&mode| may_choose(mode, origin(scene))) else {
        return chosen;
    };
    let lit = lit(&chosen, mode, seen);
    let is_drawable = |scene: &SceneFlags| {
        let settings = scene.settings(made_for.depth);
        settings.is_ok_and(|settings| check(scene, &settings).is_ok())
    };
    // More lights than there may be are refused as they are asked for, not left out.
    let is_asked = scene.light.light.len() > MAX_LIGHTS as usize;
    if let Some(lit) = lit.filter(|lit| is_asked || is_drawable(lit)) {
        chosen = lit;
    }
    let mut slabs = chosen.clone();
    slabs.sampling.preintegrated = true;
    if may_choose_slabs(&chosen) && is_sheets(&chosen, seen) && is_drawable(&slabs) {
        return slabs;
    }
    let sampling = &mut chosen.sampling;
    let is_plain = !sampling.preintegrated && sampling.adaptive_steps.is_none();
    // What is between two sheets of splats lies in both.
    let is_splatted = sampling
        .technique
        .is_some_and(|technique| technique.splats());
    // Each of several volumes has a gradient at each sample: one lit sample shows the shape that two would.
    let is_lit_mixture = seen.is_beside_others && chosen.light.shading.is_some();
    if !made_for.is_film && is_plain && sampling.has_steps() && !is_splatted && !is_lit_mixture {
        sampling.samples_per_voxel.get_or_insert(STILL_SAMPLES);
    }
    chosen
}

/// The mode, where the picture is one of the volume: neither a section nor spheres in place of it.
fn mode(scene: &SceneFlags) -> Option<Mode> {
    let word = scene.sampling.mode.unwrap_or(Mode::Composite);
    let is_other = scene.section.section.is_some() || scene.points_are_spheres();
    (!is_other).then_some(word)
}

fn origin(scene: &SceneFlags) -> Origin {
    let classification = &scene.classification;
    let preset = classification.preset.as_deref().and_then(Preset::from_name);
    match (&classification.transfer_function, preset) {
        (Some(_), _) => Origin::Given,
        (None, Some(preset)) => Origin::Preset(preset),
        (None, None) => Origin::Automatic,
    }
}

/// True where no flag says how samples are taken; one that has no effect says nothing.
fn may_choose_slabs(scene: &SceneFlags) -> bool {
    let sampling = &scene.sampling;
    let has_samples = sampling.has_steps() && sampling.samples_per_voxel.is_some();
    let is_open = !has_samples && sampling.adaptive_steps.is_none();
    is_open && !sampling.says_how() && scene.classification.preset.is_none()
}

/// True for fields, whose function is thinner than samples lie apart.
fn is_sheets(scene: &SceneFlags, seen: Seen) -> bool {
    let is_function = matches!(seen.classification, Classification::Function(_));
    let kind = |context: &Context| context.choice(&summary(seen.volume)).kind;
    let is_unlit = scene.light.shading.is_none();
    is_unlit && is_function && seen.is_alone && seen.context.map(kind) == Some(Kind::Field)
}

/// The lit scene, where light shows a shape.
fn lit(scene: &SceneFlags, mode: Mode, seen: Seen) -> Option<SceneFlags> {
    let light = &scene.light;
    if !(seen.is_alone || seen.is_beside_others)
        || light.shading == Some(ShadingWord::None)
        || light.shadows.is_some()
    {
        return None;
    }
    let volume = seen.volume;
    let Classification::Function(function) = seen.classification else {
        return None;
    };
    let kind = || {
        let summary = summary(volume);
        match seen.context {
            Some(context) => context.choice(&summary).kind,
            None => Kind::of(&summary),
        }
    };
    if function.uses_gradient() || !is_lit(mode, origin(scene), kind) {
        return None;
    }
    let mut lit = scene.clone();
    let light = &mut lit.light;
    light.shading = Some(ShadingWord::Phong);
    light.material.get_or_insert(Numbers(MATERIAL));
    if light.light.is_empty() {
        light.light.push(LightWord::of_camera(LIGHT));
    }
    light
        .half_gradient
        .get_or_insert_with(|| half_gradient(volume));
    Some(lit)
}
