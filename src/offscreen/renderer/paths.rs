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
use crate::technique::pathtrace::PathTracing;
use crate::technique::{InPixel, Settings};

/// Paths of one pass where no driver counts the turns of loops.
const AT_ONCE: u32 = 16;

/// How many paths of a pixel one pass traces, at most: of a driver that ends loops, one.
pub(super) fn paths_at_once(max_loop_turns: u32) -> u32 {
    match max_loop_turns {
        u32::MAX => AT_ONCE,
        _ => 1,
    }
}

impl Renderer<'_> {
    /// The mean of all paths.
    pub(super) fn mean_of_paths(
        &mut self,
        scene: &Scene,
        clock: &mut Clock,
    ) -> Result<Vec<[f32; 4]>, Error> {
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
