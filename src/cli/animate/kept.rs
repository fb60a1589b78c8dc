//! What a film was drawn with, for its scene: chosen once for all frames, beside what keys say.

use super::{
    draw::Content,
    ready::Ready,
    shots::{Film, FilmFrame},
};
use crate::{
    cli::{
        flags::{Classification, ClassificationFlags, SceneFlags},
        look::{Chosen, base_of, ends_of, without_parts},
        scene_inputs::Parts,
    },
    technique::{Filter, Settings},
};
use std::sync::OnceLock;

/// What is found while a film is drawn.
#[derive(Default)]
pub struct Kept {
    /// Whether a scene is asked for at all.
    is_wanted: bool,
    /// A frame as the flags alone say it.
    chosen: OnceLock<Ready>,
    /// Between which values the first frame compares maxima.
    unit_values: OnceLock<[f64; 2]>,
    /// The window of integrals that the first frame has found.
    pub window: OnceLock<[f64; 2]>,
}

impl Kept {
    /// Of a film whose scene is wanted or not.
    pub fn new(is_wanted: bool) -> Self {
        Self {
            is_wanted,
            ..Self::default()
        }
    }

    /// The shots, and behind them one as the flags alone say it, where its function is to be kept.
    pub fn with_own(&self, shots: &[FilmFrame], film: &Film, scene: &SceneFlags) -> Vec<FilmFrame> {
        let mut all = shots.to_vec();
        if let (true, Some(classification)) = (self.is_wanted, own(film, scene, &shots[0].settings))
        {
            all.push(FilmFrame {
                classification,
                ..shots[0].clone()
            });
        }
        all
    }

    /// Takes that one from behind the `count` frames of the film.
    pub fn take(&self, ready: &mut Vec<Ready>, count: usize) {
        if ready.len() > count
            && let Some(own) = ready.pop()
        {
            let _ = self.chosen.set(own);
            let per_mode = &ready[0].settings.per_mode;
            let _ = self.unit_values.set(per_mode.unit_values);
        }
    }

    /// `scene` in plain flags, of a film of these shots.
    pub fn frozen(
        &self,
        scene: &SceneFlags,
        content: &Content,
        shots: &[FilmFrame],
        film: &Film,
        height_factor: f64,
    ) -> SceneFlags {
        let own = self.chosen.get();
        let settings = own.map_or(&shots[0].settings, |own| &own.settings);
        let changed = |filter: &Filter| {
            scene.sampling.filter.is_none() && *filter != shots[0].settings.filter
        };
        let filter = Some(settings.filter).filter(changed);
        // Between two labels there is none: which times are shown depends on whether the values are found to be labels.
        let is_between = shots.iter().any(|shot| shot.time.fract() != 0.0);
        let function = match own.map(|own| &own.classification) {
            Some(Classification::Function(function)) if filter.is_none() || !is_between => {
                Some(function)
            }
            _ => None,
        };
        let parts = match content {
            Content::Still(shown) | Content::Together(shown, _) => shown.parts(),
            Content::Times(..) => Parts::Channels(Vec::new()),
        };
        // Those of the own frame lack the window of the flags.
        let per_mode = match content {
            Content::Still(shown) | Content::Together(shown, _) => &shown.per_mode,
            Content::Times(..) => &settings.per_mode,
        };
        let mode = shots[0].settings.mode;
        let is_mida = base_of(&scene.classification, mode).is_some();
        let window = match (film.changes_window(), is_mida) {
            (true, _) => None,
            (false, true) => self.unit_values.get().copied(),
            (false, false) => self.window.get().copied().or(function.and_then(ends_of)),
        };
        let chosen = Chosen {
            mode,
            function,
            beside: parts.beside(),
            channels: match content {
                Content::Still(shown) | Content::Together(shown, _) => shown.channels(),
                Content::Times(..) => &[],
            },
            window,
            levels: &per_mode.levels,
            filter,
            is_base: film.changes_window() || is_mida,
            height_factor,
        };
        chosen.frozen(scene)
    }
}

/// The words of the flags whose function a scene is to keep; `None` where keys say the function. What is laid over it by
/// the window of each key stays out of it, and so do the colours of a projection, whose ends are its window.
fn own(film: &Film, scene: &SceneFlags, settings: &Settings) -> Option<ClassificationFlags> {
    let flags = &scene.classification;
    if film.changes_function() {
        return None;
    }
    if film.changes_window() {
        return Some(without_parts(flags));
    }
    let own = match settings.mode.is_projection() {
        true => ClassificationFlags {
            window: flags.window,
            ..without_parts(flags)
        },
        false => base_of(flags, settings.mode).unwrap_or_else(|| flags.clone()),
    };
    Some(own)
}
