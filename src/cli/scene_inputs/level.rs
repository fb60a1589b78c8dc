//! The surface of a quantity that falls with height, where no word names one.

use crate::cli::Error;
use crate::cli::flags::SceneFlags;
use crate::cli::progress::Progress;
use crate::cli::readable::in_unit;
use crate::figure::short;
use crate::look::{falls_with_height, mean_at_a_third};
use crate::technique::Mode;
use crate::volume::Source;

/// The words with the value of the surface, the same for all times of `source`; `None` where they name one, or the values
/// alone decide.
pub fn with_level(
    scene: &SceneFlags,
    mode: Mode,
    source: &dyn Source,
    progress: &Progress,
) -> Result<Option<SceneFlags>, Error> {
    let header = source.header();
    let is_asked = mode == Mode::Iso && scene.modes.levels.iso.is_empty() && scene.is_auto();
    if !is_asked || !falls_with_height(header) {
        return Ok(None);
    }
    let mut seen = |done: u32, of: u32| progress.stage("level", done as usize, of as usize);
    let Some(level) = mean_at_a_third(source, &mut seen)? else {
        return Ok(None);
    };
    let level = rounded(level);
    let unit = in_unit(header.unit.as_deref());
    progress.note(&format!(
        "the surface of the value {}{unit}, the mean of all columns and times at a third of the height to three digits; --iso takes others",
        short(level)
    ));
    let mut scene = scene.clone();
    scene.modes.levels.iso = vec![level];
    Ok(Some(scene))
}

/// To three digits, as a person would write it.
fn rounded(level: f64) -> f64 {
    format!("{level:.2e}").parse().unwrap_or(level)
}
