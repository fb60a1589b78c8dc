//! Where a picture rests, light that scatters: paths that add up from frame to frame, until there are enough.
//!
//! ```text
//! something changes      the picture of the look, at once
//! nothing does           after a few frames paths in its place, more of them in each frame
//! ```

use crate::error::Error;
use crate::look::Look;
use std::sync::Arc;
use stratavox::embed::{Renderer, RendererDesc, Volume};
use stratavox::gpu::Gpu;
use stratavox::technique::pathtrace::PathTracing;
use stratavox::technique::{Filter, Light, LightSpace, Mode, Settings, Technique};

/// Frames in which nothing changes, before there are paths.
const STILL: u32 = 3;
/// Paths a pixel, all in all and of one frame.
const PATHS: u32 = 64;
const PATHS_PER_FRAME: u32 = 1;

/// Pictures of paths of what a drawing shows.
#[derive(Default)]
pub struct Resting {
    renderer: Option<Renderer>,
    still: u32,
    /// Of the picture that is shown.
    paths: u32,
}

impl Resting {
    /// The picture has changed; `is_other`: more of it than the eye.
    pub fn disturb(&mut self, is_other: bool) {
        (self.still, self.paths) = (0, 0);
        if is_other {
            self.renderer = None;
        }
    }

    /// What is drawn in place of the picture, once it has rested for long enough.
    pub fn wait(
        &mut self,
        gpu: &Arc<Gpu>,
        volume: &Arc<Volume>,
        look: &Look,
        drawn: &Renderer,
    ) -> Result<Option<&mut Renderer>, Error> {
        let Some(settings) = settings(look) else {
            return Ok(None);
        };
        self.still = STILL.min(self.still + 1);
        if self.still < STILL {
            return Ok(None);
        }
        let renderer = match self.renderer.take() {
            Some(there) => there,
            None => {
                let desc = RendererDesc {
                    settings,
                    picks: false,
                    ..drawn.class().clone()
                };
                Renderer::new(gpu, volume, look.function(), desc, drawn.extent(), &[])?
            }
        };
        Ok(Some(self.renderer.insert(renderer)))
    }

    /// The picture of paths was recorded.
    pub fn show(&mut self) {
        self.paths = self.renderer.as_ref().map_or(0, Renderer::paths_traced);
    }

    /// How many paths are shown, of how many; `None`: there will be none.
    pub fn paths(&self, look: &Look) -> Option<[u32; 2]> {
        look.rests().then_some([self.paths, PATHS])
    }

    /// How noisy the picture is, once that is known.
    pub fn noise(&self) -> Option<f64> {
        let shown = self.renderer.as_ref().filter(|_| self.paths > 0);
        shown.and_then(Renderer::noise)
    }

    /// Whether more of them are to come.
    pub fn goes_on(&self, look: &Look) -> bool {
        let paths = self.paths(look);
        paths.is_some_and(|[traced, all]| traced < all)
    }
}

impl Look {
    /// Whether light scatters in the picture where it rests.
    pub fn rests(&self) -> bool {
        settings(self).is_some()
    }
}

/// Matter, surfaces and light of `stratavox render --look cinematic`, which also takes out noise, has a curve of tones and a stop more of light.
fn settings(look: &Look) -> Option<Settings> {
    let is_possible = look.scatters
        && look.technique == Technique::Raycast
        && look.mode == Mode::Composite
        && matches!(look.filter, Filter::Linear | Filter::Nearest);
    let key = Light {
        towards: glam::dvec3(-0.54, 0.64, 0.54),
        space: LightSpace::Camera,
        srgb: [1.0; 3],
    };
    is_possible.then(|| Settings {
        technique: Technique::Pathtrace,
        filter: look.filter,
        path: PathTracing {
            samples: PATHS,
            samples_per_frame: PATHS_PER_FRAME,
            density: 0.5,
            lights: vec![key],
            light_size_degrees: 40.0,
            sky: [0.35; 3],
            surface: 8.0,
            f0: 0.04,
            roughness: 0.45,
            ..PathTracing::default()
        },
        ..Settings::default()
    })
}
