//! How each frame of a film is computed and coloured, once values are known.

use super::{shots::FilmFrame, volumes::Volumes};
use crate::{
    cli::{
        Error,
        flags::{Classification, SceneFlags},
        progress::Progress,
        scene_inputs::SceneInputs,
    },
    technique::{Filter, Settings},
    transfer::ValueSummary,
};
use std::collections::BTreeSet;

/// One frame, ready to be drawn.
pub struct Ready {
    /// How values are seen.
    pub classification: Classification,
    /// What is computed.
    pub settings: Settings,
    /// The time, counted from 0.
    pub time: f64,
}

/// Frames of one time: as `render` draws it, or as keys say of one number a voxel.
pub fn of_still(
    shots: &[FilmFrame],
    scene: &SceneFlags,
    shown: &SceneInputs,
) -> Result<Vec<Ready>, Error> {
    let ready = |shot: &FilmFrame| {
        let mut settings = shot.settings.clone();
        let (classification, filter) = if shot.classification == scene.classification {
            (shown.classification.clone(), shown.filter)
        } else {
            let found = shot
                .classification
                .classification(shown.looked_at(), settings.mode)?;
            let are_labels = shot.classification.found_labels(&found);
            (found, are_labels.then_some(Filter::Nearest))
        };
        if let (None, Some(filter)) = (scene.sampling.filter, filter) {
            settings.filter = filter;
        }
        settings.per_mode = shown.per_mode.clone();
        Ok(Ready {
            classification,
            settings,
            time: shot.time,
        })
    };
    shots.iter().map(ready).collect()
}

/// Frames of several times; reads values only where they decide something.
pub fn of_times(
    shots: &[FilmFrame],
    scene: &SceneFlags,
    is_labels: bool,
    volumes: &mut Volumes,
    progress: &Progress,
) -> Result<Vec<Ready>, Error> {
    let times = shots
        .iter()
        .flat_map(|shot| [shot.time.floor(), shot.time.ceil()]);
    let times: BTreeSet<u32> = times.map(|time| time as u32).collect();
    let mut known: Option<ValueSummary> = None;
    let mut ready = Vec::with_capacity(shots.len());
    for shot in shots {
        let mut summary = || {
            let found = match known.take() {
                Some(found) => found,
                None => volumes.summary(&times)?,
            };
            Ok(known.insert(found).clone())
        };
        let mode = shot.settings.mode;
        let classification = shot.classification.classification_of(mode, &mut summary)?;
        if let Classification::Function(function) = &classification
            && function
                .gradient_transfer
                .as_ref()
                .is_some_and(|g| g.steepest.is_none() && g.needs_steepest())
        {
            return Err(Error::usage(
                "the steepest gradient of several times is not known, and the transfer function asks for it",
                "say it in the file: \"steepest\": 300",
            ));
        }
        let flags = shot.classification.with_window_of(mode, &mut summary)?;
        let window = flags.window()?;
        let (per_mode, note) = scene.modes.per_mode(
            mode,
            window,
            shot.classification.named(&classification),
            &mut summary,
        )?;
        // The same for all frames, unless keys move the window.
        if let (Some(note), true) = (note, ready.is_empty()) {
            progress.note(&note);
        }
        ready.push(Ready {
            classification,
            settings: Settings {
                per_mode,
                ..shot.settings.clone()
            },
            time: shot.time,
        });
    }
    if known.is_some() {
        progress.note(&format!(
            "colours are chosen for all {} times together",
            times.len()
        ));
    }
    let found_labels = |(shot, ready): (&FilmFrame, &Ready)| {
        shot.classification.found_labels(&ready.classification)
    };
    let are_labels = shots.iter().zip(&ready).all(found_labels);
    if are_labels && scene.sampling.filter.is_none() {
        ready
            .iter_mut()
            .for_each(|ready| ready.settings.filter = Filter::Nearest);
        progress.note("the values look like labels: drawn with --filter nearest");
    }
    if are_labels || is_labels {
        // Between two labels there is none.
        ready
            .iter_mut()
            .for_each(|ready| ready.time = ready.time.round());
    }
    Ok(ready)
}
