//! Pictures of random paths, some of them at a time.
//!
//! ```text
//! picture = sum over blocks of paths (block / all) picture of the block
//! ```
//!
//! A block is one pass over the picture, cut by tiles as any other; between two of them a picture can end. Which paths are
//! a block depends on their numbers alone, and all of a block are of one half, so that a picture that is gone on with has the blocks of one that never stopped.

use super::Renderer;
use super::path_sums::PathSums;
use crate::offscreen::Error;
use crate::offscreen::layer_rules::{Clock, has_path_layers};
use crate::picture::{Layer, LayerKind};
use crate::scene::Scene;
use crate::technique::pathtrace::{
    PathTracing, denoised, half_of_path, left_of_half, paths_at_once,
};
use crate::technique::{InPixel, Settings};
use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Behind each multiple of so many paths blocks are as large as they come.
const ALIKE_FROM: u32 = 16;

/// The fewest paths after which is looked at the noise; then at each doubling.
const FIRST_LOOK: u32 = 16;

/// How long paths are traced before their sums are kept anew.
const KEPT_EVERY: Duration = Duration::from_secs(30);

/// How many paths the block that begins with this one has: all are of one half. The first come in blocks of few, so that of few
/// paths several blocks tell the noise.
fn block_from(number: u32, at_once: u32) -> u32 {
    at_once.min(left_of_half(number))
}

/// How many passes so many paths take from this one on, of which so many come at once.
pub(super) fn passes_of_paths(first: u32, paths: u32, at_once: u32) -> u32 {
    let (mut number, mut left, mut passes) = (first, paths, 0);
    while left > 0 {
        // Behind the first ones all blocks are alike.
        if number.is_multiple_of(ALIKE_FROM) && number > 0 {
            return passes + left.div_ceil(at_once);
        }
        let block = block_from(number, at_once).min(left);
        (number, left, passes) = (number + block, left - block, passes + 1);
    }
    passes
}

/// What the last picture of paths took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Traced {
    /// Paths of each pixel, with those that it began with.
    pub paths: u32,
    /// Those that it began with.
    pub begun: u32,
    /// What tracing the others took.
    pub seconds: f64,
    /// The standard error of luminance, as a part of what the picture shows; `None`: one block does not tell.
    pub noise: Option<f64>,
}

/// When a picture ends before all paths are traced, and what it begins with.
#[derive(Debug, Default)]
pub(super) struct Ends<'v> {
    asked: Option<Arc<AtomicBool>>,
    begun: PathSums,
    keeping: Option<Keeping<'v>>,
    pub(super) traced: Traced,
    watching: Option<Watching<'v>>,
}

impl Traced {
    /// How long the rest of a picture of such paths takes, by what these took and the noise that they left; `None` before there are
    /// any.
    pub fn seconds_left(&self, path: &PathTracing) -> Option<f64> {
        let traced = self.paths.checked_sub(self.begun).filter(|&n| n > 0)?;
        let of_one = self.seconds / f64::from(traced);
        let all = of_one * f64::from(path.samples.saturating_sub(self.paths));
        // Noise falls with the root of the number of paths.
        let of_noise = path.noise.zip(self.noise).map(|(wanted, noise)| {
            let times = (noise / wanted).powi(2) - 1.0;
            of_one * f64::from(self.paths) * times.max(0.0)
        });
        let of_time = path
            .seconds
            .map(|seconds| (seconds - self.seconds).max(0.0));
        let ends = of_noise.into_iter().chain(of_time);
        Some(ends.fold(all, f64::min))
    }
}

/// Who is told what has been traced.
struct Watching<'v>(Box<dyn FnMut(Traced) + Send + 'v>);

impl fmt::Debug for Watching<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Watching").finish_non_exhaustive()
    }
}

/// Who keeps the sums of whole blocks.
struct Keeping<'v> {
    keep: Box<dyn FnMut(&PathSums) + Send + 'v>,
    kept: Instant,
}

impl fmt::Debug for Keeping<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Keeping").finish_non_exhaustive()
    }
}

impl<'v> Renderer<'v> {
    /// From here on a picture of paths ends with the block that is being traced once `asked` is true: it is the mean of
    /// what has been traced.
    pub fn end_paths_when(&mut self, asked: Arc<AtomicBool>) {
        self.path_ends.asked = Some(asked);
    }

    /// The next picture of paths goes on from `begun`, sums of the same picture; none of them: from its beginning. `keep` is
    /// told the sums, with those of the layers of the picture and of the guides of [`PathTracing::denoise`], after each 30 s of tracing and at the end of a picture, without a last block that `samples` cuts off:
    /// a picture that goes on from there is, bit by bit, the one of a run that never stopped.
    pub fn keep_paths(&mut self, begun: PathSums, keep: impl FnMut(&PathSums) + Send + 'v) {
        self.path_ends.begun = begun;
        self.path_ends.keeping = Some(Keeping {
            keep: Box::new(keep),
            kept: Instant::now(),
        });
    }

    /// From here on `watch` is told after each block of paths what has been traced.
    pub fn watch_paths(&mut self, watch: impl FnMut(Traced) + Send + 'v) {
        self.path_ends.watching = Some(Watching(Box::new(watch)));
    }

    /// What the last picture of paths took.
    pub fn traced(&self) -> Traced {
        self.path_ends.traced
    }

    /// The mean of all paths, without noise where that is asked for, and layers, which keep theirs.
    pub(super) fn picture_of_paths(
        &mut self,
        scene: &Scene,
        wanted: &[LayerKind],
        clock: &mut Clock,
    ) -> Result<(Vec<[f32; 4]>, Vec<Layer>), Error> {
        let all = &scene.settings.path;
        let turns = self.device.gpu().limits().max_loop_turns;
        let at_once = paths_at_once(scene.transfer, turns);
        let begun = Instant::now();
        let mut sums = std::mem::take(&mut self.path_ends.begun);
        sums.want(wanted, all.denoise || self.path_ends.keeping.is_some())?;
        let begun_paths = sums.paths();
        self.passes_done[0] = passes_of_paths(all.first_sample, begun_paths, at_once) as usize;
        let traced = |sums: &PathSums| Traced {
            paths: sums.paths(),
            begun: begun_paths,
            seconds: begun.elapsed().as_secs_f64(),
            noise: sums.noise(),
        };
        let has_ended = loop {
            if self.path_ends.are_reached(&sums, all, begun) {
                break true;
            }
            let paths = block_from(all.first_sample + sums.paths(), at_once);
            if sums.paths() + paths > all.samples {
                break false;
            }
            self.trace(scene, paths, &mut sums, clock)?;
            self.path_ends.keep(&sums, KEPT_EVERY);
            if let Some(Watching(watch)) = &mut self.path_ends.watching {
                watch(traced(&sums));
            }
        };
        self.path_ends.keep(&sums, Duration::ZERO);
        // Less than a block.
        let rest = all.samples.saturating_sub(sums.paths());
        if !has_ended && rest > 0 {
            self.trace(scene, rest, &mut sums, clock)?;
        }
        self.path_ends.traced = traced(&sums);
        let width = scene.extent_pixels[0] as usize;
        let pixels = match sums.halves().filter(|_| all.denoise) {
            Some([first, second]) => {
                let [by_first, by_second] = sums.guides();
                denoised([&first, &second], [&by_first, &by_second], width)
            }
            None => sums.mean(),
        };
        let layers = wanted.iter().map(|&kind| sums.layer(kind));
        Ok((pixels, layers.collect()))
    }

    /// One more block.
    fn trace(
        &mut self,
        scene: &Scene,
        paths: u32,
        sums: &mut PathSums,
        clock: &mut Clock,
    ) -> Result<(), Error> {
        let all = &scene.settings.path;
        let settings = &Settings {
            path: PathTracing {
                first_sample: all.first_sample + sums.paths(),
                samples: paths,
                denoise: false,
                ..all.clone()
            },
            ..scene.settings.clone()
        };
        let block = &Scene { settings, ..*scene };
        let (found, gpu_ms) = self.colors(block, InPixel::CENTER)?;
        clock.add(gpu_ms);
        let half = half_of_path(settings.path.first_sample);
        self.add_path_images((half, paths), sums.images())?;
        sums.add(half, &found, paths);
        Ok(())
    }

    /// Whether paths leave images beside their picture: for layers, for the filter that takes noise out, and for whoever
    /// keeps the sums, who may want them later.
    pub(super) fn leaves_path_images(&self, settings: &Settings, wanted: &[LayerKind]) -> bool {
        let ends = &self.path_ends;
        settings.technique.traces_paths()
            && (settings.path.denoise
                || ends.keeping.is_some()
                || ends.begun.have_images()
                || has_path_layers(wanted))
    }
}

impl Ends<'_> {
    /// Whether a picture that `begun` to be traced then has all that it asks for; one block it has.
    fn are_reached(&self, sums: &PathSums, all: &PathTracing, begun: Instant) -> bool {
        let paths = sums.paths();
        let is_late = |seconds| begun.elapsed() >= Duration::from_secs_f64(seconds);
        let is_asked = |asked: &Arc<AtomicBool>| asked.load(Ordering::Relaxed);
        let is_looked_at = paths >= FIRST_LOOK && paths.is_power_of_two();
        let is_clear = |most| is_looked_at && sums.noise().is_some_and(|noise| noise <= most);
        let has_ended = all.seconds.is_some_and(is_late)
            || self.asked.as_ref().is_some_and(is_asked)
            || all.noise.is_some_and(is_clear);
        paths > 0 && has_ended
    }

    fn keep(&mut self, sums: &PathSums, every: Duration) {
        if let Some(Keeping { keep, kept }) = &mut self.keeping
            && sums.paths() > 0
            && kept.elapsed() >= every
        {
            keep(sums);
            *kept = Instant::now();
        }
    }
}
