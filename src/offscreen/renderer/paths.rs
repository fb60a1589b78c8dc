//! Pictures of random paths, some of them at a time.
//!
//! ```text
//! picture = sum over blocks of paths (block / all) picture of the block
//! noise   = sqrt(sum over pixels of the variance of their means) / sqrt(sum of their squares)      of luminance
//! ```
//!
//! A block is one pass over the picture, cut by tiles as any other; between two of them a picture can end. The variance of
//! a mean of n blocks is that of the blocks over n.

use super::Renderer;
use crate::offscreen::Error;
use crate::offscreen::layer_rules::Clock;
use crate::scene::Scene;
use crate::technique::pathtrace::{PATHS_OF_LOOP, PathTracing, denoised};
use crate::technique::{InPixel, Settings};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Paths of one pass where no driver counts the turns of loops.
const AT_ONCE: u32 = 8;

/// How often is looked at the noise: at so many paths, and at each doubling.
const FIRST_LOOK: u32 = 16;

/// How many paths of a pixel one pass traces, at most: fewer than all, so that blocks differ by their noise.
fn paths_at_once(path: &PathTracing, max_loop_turns: u32) -> u32 {
    let most = match max_loop_turns {
        u32::MAX => AT_ONCE,
        _ => PATHS_OF_LOOP,
    };
    most.min(path.samples.div_ceil(2))
}

/// How many passes a picture takes.
pub(super) fn passes_of_paths(path: &PathTracing, max_loop_turns: u32) -> u32 {
    path.samples.div_ceil(paths_at_once(path, max_loop_turns))
}

/// What the last picture of paths took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Traced {
    /// Paths of each pixel.
    pub paths: u32,
    /// The standard error of luminance, as a part of what the picture shows; `None`: one block does not tell.
    pub noise: Option<f64>,
}

/// When a picture ends before all paths are traced.
#[derive(Debug, Default)]
pub(super) struct Ends {
    asked: Option<Arc<AtomicBool>>,
    pub(super) traced: Traced,
}

impl<'v> Renderer<'v> {
    /// From here on a picture of paths ends with the block that is being traced once `asked` is true: it is the mean of
    /// what has been traced.
    pub fn end_paths_when(&mut self, asked: Arc<AtomicBool>) {
        self.path_ends.asked = Some(asked);
    }

    /// What the last picture of paths took.
    pub fn traced(&self) -> Traced {
        self.path_ends.traced
    }

    /// The mean of all paths, without noise where that is asked for.
    pub(super) fn picture_of_paths(
        &mut self,
        scene: &Scene,
        clock: &mut Clock,
    ) -> Result<Vec<[f32; 4]>, Error> {
        let all = &scene.settings.path;
        let end = all.first_sample + all.samples;
        let at_once = paths_at_once(all, self.device.gpu().limits().max_loop_turns);
        let begun = Instant::now();
        let mut sums = Sums::default();
        let mut first_look = FIRST_LOOK;
        while sums.paths < all.samples {
            let first_sample = all.first_sample + sums.paths;
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
            sums.add(&found, samples, all.denoise);
            let is_time = |seconds| begun.elapsed() >= Duration::from_secs_f64(seconds);
            let asked = self.path_ends.asked.as_ref();
            if all.seconds.is_some_and(is_time)
                || asked.is_some_and(|asked| asked.load(Ordering::Relaxed))
            {
                break;
            }
            if sums.paths >= first_look {
                first_look = 2 * sums.paths;
                let noise = sums.noise();
                if all
                    .noise
                    .is_some_and(|most| noise.is_some_and(|noise| noise <= most))
                {
                    break;
                }
            }
        }
        self.path_ends.traced = Traced {
            paths: sums.paths,
            noise: sums.noise(),
        };
        Ok(match all.denoise && sums.blocks > 1 {
            true => {
                let [first, second] = [0, 1].map(|half| sums.mean_of(half));
                denoised([&first, &second], scene.extent_pixels[0] as usize)
            }
            false => sums.mean_of(0),
        })
    }
}

/// What blocks have brought.
#[derive(Debug, Default)]
struct Sums {
    /// Of even and of odd blocks, two pictures of different paths; or all in the first.
    halves: [Vec<[f64; 4]>; 2],
    paths_of_halves: [u32; 2],
    paths: u32,
    blocks: u32,
    /// Of the luminance of each block's pixels: the sum, and that of squares.
    luminance: Vec<[f64; 2]>,
}

impl Sums {
    fn add(&mut self, found: &[[f32; 4]], paths: u32, keeps_halves: bool) {
        let half = match keeps_halves {
            true => (self.blocks % 2) as usize,
            false => 0,
        };
        self.halves[half].resize(found.len(), [0.0; 4]);
        self.luminance.resize(found.len(), [0.0; 2]);
        for (sum, found) in self.halves[half].iter_mut().zip(found) {
            *sum = std::array::from_fn(|c| sum[c] + f64::from(paths) * f64::from(found[c]));
        }
        for (sum, found) in self.luminance.iter_mut().zip(found) {
            let y = luminance(found.map(f64::from));
            *sum = [sum[0] + y, sum[1] + y * y];
        }
        self.paths_of_halves[half] += paths;
        self.paths += paths;
        self.blocks += 1;
    }

    fn mean_of(&self, half: usize) -> Vec<[f32; 4]> {
        let count = f64::from(self.paths_of_halves[half]);
        let mean = |sum: &[f64; 4]| sum.map(|s| (s / count) as f32);
        self.halves[half].iter().map(mean).collect()
    }

    /// A block of fewer paths counts as one of all.
    fn noise(&self) -> Option<f64> {
        if self.blocks < 2 {
            return None;
        }
        let n = f64::from(self.blocks);
        let [mut variance, mut squares] = [0.0; 2];
        for [sum, sum_of_squares] in &self.luminance {
            let mean = sum / n;
            variance += ((sum_of_squares / n - mean * mean) / (n - 1.0)).max(0.0);
            squares += mean * mean;
        }
        (squares > 0.0).then(|| (variance / squares).sqrt())
    }
}

/// Of linear light (ITU-R BT.709).
fn luminance([r, g, b, _]: [f64; 4]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Blocks whose pixels are 1 or 3 by chance: of a mean of n, 1 / n; against 4.
    #[test]
    fn noise_is_the_error_of_the_mean() {
        let mut sums = Sums::default();
        for block in 0..64 {
            let pixel = |i: u32| {
                // A mixer of whole numbers (Wellons' lowbias32, 2018).
                let mut x = i + 4096 * block;
                x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
                x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
                [if (x >> 16) & 1 == 0 { 1.0 } else { 3.0 }; 4]
            };
            let found: Vec<_> = (0..4096).map(pixel).collect();
            sums.add(&found, 4, true);
        }
        let noise = sums.noise().expect("64 blocks tell");
        assert!((noise - 1.0 / 16.0).abs() < 2e-3, "{noise}");
        assert_eq!(sums.paths, 256);
        assert_eq!(sums.paths_of_halves, [128; 2]);
        let halves = [0, 1].map(|half| sums.mean_of(half));
        assert!(halves[0] != halves[1]);
    }
}
