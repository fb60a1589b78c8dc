//! A scene of which nothing is left to choose: what a scene file keeps.

use super::View;
use crate::cli::flags::{
    Classification, ColorWord, FilterWord, Look, SceneFlags, ShadingWord, WindowWord,
};
use crate::cli::shown::Shown;
use crate::scene::Beside;
use crate::technique::{Level, Mode};
use crate::transfer::transfer_function_to_json;

/// The flags of a picture that was drawn, with the function that the program chose. Of several volumes in one picture
/// the functions follow from the values again.
pub fn frozen(view: &View, shown: &Shown) -> SceneFlags {
    let mut scene = view.scene.clone();
    if scene.is_auto() && view.settings.mode == Mode::Composite {
        scene.input.keep_all.get_or_insert(false);
    }
    if !matches!(shown.parts().beside(), Beside::Nothing) {
        return scene;
    }
    let mode = view.settings.mode;
    let chosen = &mut scene.classification;
    let is_chosen = chosen.preset.is_none() && chosen.transfer_function.is_none();
    let Classification::Function(function) = &shown.classification else {
        return scene;
    };
    if mode == Mode::Iso {
        // Surfaces stand by themselves, whatever the function.
        keep_levels(&mut scene, &view.settings.per_mode.levels);
    } else if is_chosen && mode.is_projection() {
        let [low, high] = shown.looked_at().value_range;
        if low < high {
            chosen.window.get_or_insert(WindowWord::Values([low, high]));
        }
    } else if is_chosen && !function.is_graded() {
        let text = transfer_function_to_json(function);
        chosen.transfer_function =
            Some(serde_json::from_str(&text).expect("what we have just written as JSON"));
        // It lies where the window has put it.
        chosen.window = None;
        (chosen.color_function, chosen.opacity_function) = (None, None);
        chosen.colormap = None;
        if let Some(filter) = shown.filter {
            scene.sampling.filter.get_or_insert(FilterWord::of(filter));
        }
    }
    if scene.light.shading.is_none() && !scene.light.is_lit(mode) {
        scene.light.shading = Some(ShadingWord::None);
    }
    scene.sampling.samples_per_voxel.get_or_insert(1.0);
    scene.look = Some(Look::Plain);
    scene
}

/// The surfaces that were drawn, where the flags name none.
fn keep_levels(scene: &mut SceneFlags, levels: &[Level]) {
    let flags = &mut scene.modes.levels;
    if !flags.iso.is_empty() {
        return;
    }
    flags.iso = levels.iter().map(|level| level.value).collect();
    if flags.iso_color_by.is_none() {
        let colors = levels.iter().map(|level| ColorWord(level.srgb));
        flags.iso_color = colors.collect();
    }
    flags.iso_opacity = levels.iter().map(|level| level.opacity).collect();
}
