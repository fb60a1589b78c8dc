//! How long the next picture will take, by what the last one took.

use super::Renderer;
use super::paths::passes_of_paths;
use crate::offscreen::time_slices::Spent;
use crate::scene::Scene;
use crate::technique::cost::{fetches_of_picture, ms_of_fetches};
use crate::technique::pathtrace::{PathTracing, paths_at_once};
use crate::technique::{Jitter, Recording, Settings, Skip, View};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A view that takes this much more, or less, tells nothing: what is skipped there may be another part.
const SIMILAR: f64 = 2.0;

/// Of the samples of a picture under a function that leaves something out, hardly more are taken: of a CT's bones a
/// tenth, of its skin a quarter.
const MOST_SEEN: f64 = 0.3;

/// What a picture took.
#[derive(Debug)]
pub struct Known {
    like: Like,
    fetches: f64,
    ms: f64,
}

/// What pictures have in common that take about the same for each look.
#[derive(Clone, Debug, PartialEq)]
pub struct Like {
    settings: Settings,
    shown: usize,
    /// Changes of the transfer functions before.
    functions: u64,
}

/// What a picture will take.
#[derive(Debug)]
pub struct Expected {
    like: Like,
    fetches: f64,
    /// All of it, rather too much than too little.
    pub ms: f64,
}

impl<'v> Renderer<'v> {
    /// How long a submission shall take: 100 ms unless said, 200 ms where the device is the processor. Work on the
    /// device is cut into submissions that are measured, so that none takes much longer, the first pictures of a kind
    /// carefully. The picture is the same however it is cut: infinity is one submission, 0 the smallest parts that
    /// there are.
    pub fn set_submission_ms(&mut self, target_ms: f64) {
        self.slices.target_ms = target_ms;
    }

    /// From here on `watch` is told, after each submission that draws, how much of the picture is done, 0 to 1.
    pub fn watch(&mut self, watch: impl FnMut(f64) + Send + 'v) {
        self.slices.watch(Box::new(watch));
    }

    /// From here on nothing is submitted while `stop` is true: what was asked for ends with
    /// [`gpu::Error::Stopped`](crate::gpu::Error::Stopped) when the submission at work is done, within 250 ms. Once it
    /// is false again pictures can be drawn as before.
    pub fn stop_when(&mut self, stop: Arc<AtomicBool>) {
        self.device.stop_when(stop);
    }

    /// What a pass over all samples will take.
    pub(super) fn expected(
        &self,
        scene: &Scene,
        view: &View,
        recordings: &[Recording],
        volumes: usize,
    ) -> Expected {
        let slices = match scene.settings.is_half_angle() {
            // What the light sees is taken for as much.
            true => 2 * recordings[0].slices,
            false => recordings.iter().map(|one| one.slices).sum(),
        };
        let fetches = fetches_of_picture(view, slices, volumes);
        let like = Like {
            settings: Settings {
                jitter: Jitter::default(),
                path: PathTracing {
                    first_sample: 0,
                    ..scene.settings.path.clone()
                },
                ..scene.settings.clone()
            },
            shown: self.shown,
            functions: match scene.settings.mode.is_projection() {
                true => 0,
                false => self.changes,
            },
        };
        let is_similar = |known: &&Known| {
            let range = known.fetches / SIMILAR..=known.fetches * SIMILAR;
            known.like == like && range.contains(&fetches)
        };
        let gpu = self.device.gpu();
        let seen = match self.skipped.skip() {
            // Where nothing is known of the device either, one of the two is allowed for.
            Skip::Unseen(..) if gpu.is_cpu() => MOST_SEEN,
            _ => 1.0,
        };
        let guess = seen * ms_of_fetches(gpu, fetches);
        let ms = match self.known.as_ref().filter(is_similar) {
            Some(known) => known.ms * fetches / known.fetches,
            None => guess,
        };
        Expected { like, fetches, ms }
    }

    /// What it took.
    pub(super) fn learn(&mut self, expected: Expected, spent: &Spent) {
        let Expected { like, fetches, .. } = expected;
        let ms = spent.wall_ms;
        self.known = Some(Known { like, fetches, ms });
    }
}

/// How many passes over all samples a picture takes, of each of its volumes that are drawn one by one.
pub fn passes_of(scene: &Scene, has_layers: bool, max_loop_turns: u32) -> usize {
    let settings = scene.settings;
    let rays = match settings.technique.traces_paths() {
        true => {
            let at_once = paths_at_once(scene.transfer, max_loop_turns);
            passes_of_paths(settings.path.first_sample, settings.path.samples, at_once)
        }
        false => settings.rays_per_side.pow(2),
    };
    let rays = rays as usize;
    let is_grey = settings.mode.is_projection() && scene.transfers().iter().any(Option::is_none);
    // Layers are those of the rays through pixel centres, and slicers count samples by themselves.
    let is_drawn_again = has_layers && settings.rays_per_side > 1;
    let is_counted = has_layers && !settings.technique.casts_rays();
    let more = [is_grey, is_drawn_again, is_counted].map(usize::from);
    rays + more.iter().sum::<usize>()
}
