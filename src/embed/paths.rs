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
use crate::technique::Settings;
use crate::technique::pathtrace::{Medium, MediumFields, paths_at_once};
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
        let before = self.traced.filter(goes_on).map_or(0, |t| t.paths);
        let function = self.function.paths.as_ref().map(|of| &of.function);
        let most = paths_at_once(function, self.gpu.limits().max_loop_turns);
        let left = settings.path.samples.saturating_sub(before);
        Some(Traced {
            camera,
            updates,
            before,
            paths: before + settings.path.samples_per_frame.min(most).min(left),
        })
    }
}

impl Traced {
    /// Whether the frame begins a picture.
    pub fn is_new(&self) -> bool {
        self.before == 0
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
    pub fn new(
        function: Option<&TransferFunction>,
        settings: &Settings,
        volume: &super::Volume,
    ) -> Option<Box<Self>> {
        let function = function.filter(|_| settings.technique.traces_paths())?;
        let smallest_spacing = volume.grid().smallest_spacing();
        let fields = settings.path.fields_of(&Medium {
            function,
            absorption: settings.absorption(function, smallest_spacing),
            has_holes: volume.copies()[0].has_holes(),
            is_searched: settings.conformance,
            value_range: volume.value_range(),
            smallest_spacing,
            beside: None,
        });
        let function = function.clone();
        Some(Box::new(Self { function, fields }))
    }

    /// The same under other settings.
    pub fn under(&self, settings: &Settings, volume: &super::Volume) -> Option<Box<Self>> {
        Self::new(Some(&self.function), settings, volume)
    }
}

/// The picture of the sky on the device; `None`: it is even, or no paths are traced.
pub(super) fn sky(gpu: &Arc<Gpu>, settings: &Settings) -> Result<Option<Buffer>, Error> {
    let traces = settings.technique.traces_paths();
    let picture = settings.path.sky_picture.as_ref().filter(|_| traces);
    Ok(picture.map(|picture| picture.on_device(gpu)).transpose()?)
}
