//! Pictures of paths that frames add up: as long as nothing changes, each frame has more of them and less noise.
//!
//! ```text
//! mean = (before mean + sum of this frame's paths) / (before + of this frame)        before = 0 where something has changed
//! ```
//!
//! Frames in flight share one image of means, in the order of the queue.

use super::{Error, FrameInfo, Renderer};
use crate::camera::Camera;
use crate::gpu::{Buffer, Gpu};
use crate::shaders::Frame;
use crate::technique::pathtrace::{Medium, MediumFields, PathBlocks, paths_at_once};
use crate::technique::{self, Settings};
use crate::transfer::TransferFunction;
use std::sync::Arc;

/// What a picture of paths shows, and how many of them it is the mean of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Traced {
    camera: Camera,
    /// How often the volume had been updated.
    updates: u64,
    /// Paths of each pixel, before this frame and with it.
    before: u32,
    paths: u32,
    /// The frames that have them.
    blocks: u32,
}

impl Renderer {
    /// Of how many paths a pixel the picture of the last frame is the mean ([`Technique::Pathtrace`](crate::technique::Technique)).
    /// Each frame adds [`samples_per_frame`](crate::technique::pathtrace::PathTracing::samples_per_frame), of a driver that counts
    /// the turns of loops 4 at most (through functions of gradients 2), until there are
    /// [`samples`](crate::technique::pathtrace::PathTracing::samples): those after it trace none and show the same. Another camera, function, volume, size or settings (but for their tone), an update of the volume, and
    /// a frame in parts that was given up begin anew, with the same random numbers. What the host has drawn is not
    /// compared: see [`Renderer::restart_paths`].
    pub fn paths_traced(&self) -> u32 {
        self.traced.map_or(0, |traced| traced.paths)
    }

    /// How noisy that picture was `frames_in_flight` frames before the last one that was recorded: the root of the sum of the
    /// variances of its pixels' luminances over that of their squares, by how frames differ, as
    /// [`Traced::noise`](crate::offscreen::Traced) of offscreen pictures. It halves with four times as many paths.
    ///
    /// Nothing waits for it: each frame leaves 12 bytes, which are read when the host records with its number again. `None`
    /// while nothing is known: before that, of a picture with one frame, of a black one, and where
    /// [`Renderer::paths_traced`] begins anew; where no paths are traced; and where the device has no storage buffer of 8
    /// bytes a pixel.
    pub fn noise(&self) -> Option<f64> {
        self.traced?;
        self.path_noise.as_ref()?.known()
    }

    /// The next frame begins with the first path: where what a host has drawn has moved before the volume, and where a
    /// frame that was recorded will not be submitted.
    pub fn restart_paths(&mut self) {
        self.traced = None;
    }

    /// What the next frame is the mean of; `None` where no paths are traced.
    pub(super) fn paths_of(&self, shot: &FrameInfo) -> Option<Traced> {
        let settings = &self.class.settings;
        if !settings.technique.traces_paths() {
            return None;
        }
        let (camera, updates) = (*shot.camera, self.volume.updates.done());
        let goes_on = |traced: &Traced| traced.camera == camera && traced.updates == updates;
        let then = self.traced.filter(goes_on);
        let (before, blocks) = then.map_or((0, 0), |t| (t.paths, t.blocks));
        let function = self.function.paths.as_ref().map(|of| &of.function);
        let most = paths_at_once(function, self.gpu.limits().max_loop_turns);
        let left = settings.path.samples.saturating_sub(before);
        let more = settings.path.samples_per_frame.min(most).min(left);
        Some(Traced {
            camera,
            updates,
            before,
            paths: before + more,
            blocks: blocks + u32::from(more > 0),
        })
    }
}

impl Traced {
    /// Whether the frame begins a picture.
    pub fn is_new(&self) -> bool {
        self.before == 0
    }

    /// Whether the frame has paths.
    pub fn adds(&self) -> bool {
        self.paths > self.before
    }

    /// What the picture is the mean of: each frame is a block.
    pub fn path_blocks(&self) -> PathBlocks {
        PathBlocks {
            paths: self.paths,
            blocks: self.blocks,
        }
    }

    /// Tells the parameters of the frame how many paths come behind how many.
    pub fn tell(&self, frame: &mut Frame) {
        frame.path_before = self.before;
        frame.path_first += self.before;
        frame.path_count = self.paths - self.before;
    }
}

/// A function as paths go through it.
#[derive(Debug)]
pub(super) struct OfPaths {
    function: TransferFunction,
    pub fields: MediumFields,
}

impl OfPaths {
    /// Where paths are traced through such a volume.
    ///
    /// # Errors
    /// Where matter is too dense for paths.
    pub fn new(
        function: Option<&TransferFunction>,
        settings: &Settings,
        volume: &super::Volume,
    ) -> Result<Option<Box<Self>>, technique::Error> {
        let Some(function) = function.filter(|_| settings.technique.traces_paths()) else {
            return Ok(None);
        };
        let smallest_spacing = volume.grid().smallest_spacing();
        let fields = settings.path.fields_of(&Medium {
            function,
            absorption: settings.absorption(function, smallest_spacing),
            has_holes: volume.copies()[0].has_holes(),
            is_searched: settings.conformance,
            value_range: volume.value_range(),
            smallest_spacing,
            beside: None,
        })?;
        let function = function.clone();
        Ok(Some(Box::new(Self { function, fields })))
    }

    /// The same under other settings.
    ///
    /// # Errors
    /// Those of [`Self::new`].
    pub fn under(
        &self,
        settings: &Settings,
        volume: &super::Volume,
    ) -> Result<Option<Box<Self>>, technique::Error> {
        Self::new(Some(&self.function), settings, volume)
    }
}

/// The picture of the sky on the device; `None`: it is even, or no paths are traced.
pub(super) fn sky(gpu: &Arc<Gpu>, settings: &Settings) -> Result<Option<Buffer>, Error> {
    let traces = settings.technique.traces_paths();
    let picture = settings.path.sky_picture.as_ref().filter(|_| traces);
    Ok(picture.map(|picture| picture.on_device(gpu)).transpose()?)
}
