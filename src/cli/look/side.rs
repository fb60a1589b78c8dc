//! The side that a volume is looked at from, as flags.

use super::framing::{Small, View};
use crate::cli::Error;
use crate::cli::flags::{CameraFlags, SceneFlags, ViewWord};
use crate::look::{best_side, face};
use crate::{camera, volume::Grid};

/// The scene looking at the face of a thin slab. Pieces of the Earth are thin, and seen from the south.
pub fn with_side(
    scene: &SceneFlags,
    grid: &Grid,
    is_earth: bool,
    has_named_axes: bool,
) -> SceneFlags {
    let mut sided = scene.clone();
    let is_said = scene.section.section.is_some() || scene.camera.names_a_side();
    if !scene.is_auto() || is_said || is_earth {
        return sided;
    }
    if let Some(view) = face(grid, has_named_axes) {
        sided.camera.view = Some(match view {
            camera::View::Anterior => ViewWord::Anterior,
            camera::View::Posterior => ViewWord::Posterior,
            camera::View::Left => ViewWord::Left,
            camera::View::Right => ViewWord::Right,
            camera::View::Superior => ViewWord::Superior,
            camera::View::Inferior => ViewWord::Inferior,
        });
    }
    sided
}

/// The flags of the side that `chosen` has and `given` has not, each with a space behind it.
pub fn side_words(chosen: &CameraFlags, given: &CameraFlags) -> String {
    let mut words = String::new();
    if let (Some(view), None) = (chosen.view, given.view) {
        words += &format!("--view {} ", view.name());
    }
    if let (Some(azimuth), None) = (chosen.azimuth, given.azimuth) {
        words += &format!("--azimuth {azimuth} ");
    }
    if let (Some(elevation), None) = (chosen.elevation, given.elevation) {
        words += &format!("--elevation {elevation} ");
    }
    words
}

/// Turns the scene to the best of six sides; `boxed` fits a camera to the box.
pub fn turn_to_best(
    scene: &mut SceneFlags,
    boxed: impl Fn(SceneFlags) -> Result<View, Error>,
    extent_pixels: [u32; 2],
    draw: &mut Small,
) -> Result<(), Error> {
    let turned = |[azimuth, elevation]: [f64; 2]| {
        let mut turned = scene.clone();
        (turned.camera.azimuth, turned.camera.elevation) = (Some(azimuth), Some(elevation));
        turned
    };
    let best = best_side(extent_pixels, |side, small| {
        let view = boxed(turned(side))?;
        draw(&view.camera, &view.settings, small)
    })?;
    if let Some(side) = best {
        *scene = turned(side);
    }
    Ok(())
}
