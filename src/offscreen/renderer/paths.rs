//! Pictures of random paths, some of them at a time.
//!
//! ```text
//! picture = sum over blocks of paths (block / all) picture of the block
//! ```
//!
//! A block is one pass over the picture, cut by tiles as any other; between two of them a picture can be stopped.

use super::Renderer;
use crate::offscreen::Error;
use crate::offscreen::layer_rules::Clock;
use crate::scene::Scene;
use crate::technique::pathtrace::{PathTracing, denoised};
use crate::technique::{InPixel, Settings};

/// Paths of one pass where no driver counts the turns of loops.
const AT_ONCE: u32 = 16;

/// How many paths of a pixel one pass traces, at most: of a driver that ends loops, one.
fn paths_at_once(max_loop_turns: u32) -> u32 {
    match max_loop_turns {
        u32::MAX => AT_ONCE,
        _ => 1,
    }
}

/// How many passes a picture takes.
pub(super) fn passes_of_paths(path: &PathTracing, max_loop_turns: u32) -> u32 {
    let passes = |path: &PathTracing| path.samples.div_ceil(paths_at_once(max_loop_turns));
    match path.denoise {
        true => path.halves().iter().map(passes).sum(),
        false => passes(path),
    }
}

impl Renderer<'_> {
    /// The mean of all paths, without noise where that is asked for.
    pub(super) fn picture_of_paths(
        &mut self,
        scene: &Scene,
        clock: &mut Clock,
    ) -> Result<Vec<[f32; 4]>, Error> {
        if !scene.settings.path.denoise {
            return self.mean_of_paths(scene, clock);
        }
        let mut of_half = |path| {
            let settings = &Settings {
                path,
                ..scene.settings.clone()
            };
            self.mean_of_paths(&Scene { settings, ..*scene }, clock)
        };
        let [first, second] = scene.settings.path.halves();
        let (first, second) = (of_half(first)?, of_half(second)?);
        Ok(denoised([&first, &second], scene.extent_pixels[0] as usize))
    }

    /// The mean of all paths.
    fn mean_of_paths(&mut self, scene: &Scene, clock: &mut Clock) -> Result<Vec<[f32; 4]>, Error> {
        let all = &scene.settings.path;
        let end = all.first_sample + all.samples;
        let at_once = paths_at_once(self.device.gpu().limits().max_loop_turns);
        let mut sums: Vec<[f64; 4]> = Vec::new();
        let mut first_sample = all.first_sample;
        while first_sample < end {
            let samples = at_once.min(end - first_sample);
            let settings = &Settings {
                path: PathTracing {
                    first_sample,
                    samples,
                    ..all.clone()
                },
                ..scene.settings.clone()
            };
            let block = &Scene { settings, ..*scene };
            let (found, gpu_ms) = self.colors(block, InPixel::CENTER)?;
            clock.add(gpu_ms);
            sums.resize(found.len(), [0.0; 4]);
            for (sum, found) in sums.iter_mut().zip(found) {
                *sum = std::array::from_fn(|c| sum[c] + f64::from(samples) * f64::from(found[c]));
            }
            first_sample += samples;
        }
        let count = f64::from(all.samples);
        let mean = |sum: [f64; 4]| sum.map(|s| (s / count) as f32);
        Ok(sums.into_iter().map(mean).collect())
    }
}
