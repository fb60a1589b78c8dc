//! What a renderer is made for, and what may be another thing in each frame.

use super::Error;
use crate::camera::{Camera, HostDepth};
use crate::gpu::TargetClass;
use crate::technique::{self, Mode, Order, Settings, Technique};
use ash::vk;

/// What a renderer is made for: all that pipelines and images hang on.
#[derive(Clone, Debug)]
pub struct Class {
    /// What to compute. Numbers of it may change later ([`super::Renderer::set_settings`]), kinds may not.
    pub settings: Settings,
    /// What is drawn into: the formats, samples and depth of the host's rendering.
    pub target: TargetClass,
    /// How many frames of the host may be unfinished at once.
    pub frames_in_flight: u32,
    /// Whether what the host has drawn hides the volume: each [`Shot`] says its [`HostDepth`] then. Rays read the
    /// depth from images ([`HostDepthImage`]), slices are tested against the attachment of `target`.
    pub host_depth: bool,
    /// Whether [`super::Renderer::draw_depth`] will be called: `target` has a depth attachment then.
    pub gives_depth: bool,
}

/// Frames in flight: more than any host has.
pub(super) const MOST_FRAMES: u32 = 64;

/// A host's depth buffer as rays read it: one level, one layer, one sample, with `SAMPLED` usage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HostDepthImage {
    pub(super) view: vk::ImageView,
    pub(super) layout: vk::ImageLayout,
    pub(super) extent: [u32; 2],
}

impl HostDepthImage {
    /// A 2D view of its depth aspect; the layout that it is in when what [`super::Renderer::record`] records runs, visible
    /// to sampled reads of the compute stage; its size, which is that of the picture.
    ///
    /// # Safety
    /// The view is one of the device of the renderers that get it, and lives until they have got others
    /// ([`super::Renderer::resize`]) or are dropped, and all frames that were recorded with it are done.
    pub unsafe fn new(view: vk::ImageView, layout: vk::ImageLayout, extent: [u32; 2]) -> Self {
        Self {
            view,
            layout,
            extent,
        }
    }
}

/// From which shaders read depth: the layouts that the specification allows for it.
pub(super) const READ_DEPTH: [vk::ImageLayout; 6] = [
    vk::ImageLayout::GENERAL,
    vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
    vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
    vk::ImageLayout::DEPTH_READ_ONLY_OPTIMAL,
    vk::ImageLayout::DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL,
    vk::ImageLayout::READ_ONLY_OPTIMAL,
];

/// One frame of a host.
#[derive(Clone, Copy, Debug)]
pub struct Shot<'a> {
    /// Which of the frames in flight: nothing unfinished was recorded with this number.
    pub frame: u32,
    /// The eye.
    pub camera: &'a Camera,
    /// The host's clip space, of the same matrices as the camera: wanted where [`Class::host_depth`] or
    /// [`Class::gives_depth`] is true, and else of no use.
    pub depth: Option<HostDepth>,
}

impl Class {
    /// Refuses by name what is not drawn inside a host's frame.
    pub(super) fn check(&self) -> Result<(), Error> {
        let settings = &self.settings;
        let is_sliced = settings.technique != Technique::Raycast;
        let refused = [
            (
                settings.wants_light_volume(),
                "a picture with a light volume (shadows, ambient occlusion, half-angle slices)",
                "take `technique::LightVolume` or `HalfAngleSlicer` and record them",
            ),
            (
                settings.rays_per_side > 1,
                "a picture of several rays a pixel",
                "add up pictures of `View::in_pixel`",
            ),
            (
                is_sliced && settings.preintegrated && self.host_depth,
                "pre-integrated slicing behind what a host has drawn",
                "slabs reach out of the planes that are tested: take rays",
            ),
            (
                settings.adaptive_steps.is_some(),
                "a picture with adaptive steps",
                "take the step that it needs, or `EmptySpace::with_alike` and record it",
            ),
            (
                settings.smooth,
                "a cross-fade of two stacks",
                "draw each of `slices_2d::stack_shares`",
            ),
            (
                is_sliced && settings.order == Order::FrontToBack,
                "slicing from front to back",
                "what a host has drawn lies behind: take `Order::BackToFront`",
            ),
            (
                is_sliced && settings.mode != Mode::Composite && self.host_depth,
                "a projection by slices behind what a host has drawn",
                "take rays",
            ),
        ];
        for (is_wanted, what, hint) in refused {
            if is_wanted {
                return Err(Error::NotEmbedded { what, hint });
            }
        }
        settings.check()?;
        check_frames(self.frames_in_flight)?;
        if settings.shading.is_some() && settings.mode.is_projection() {
            let mode = settings.mode;
            return Err(technique::Error::NotShaded { mode }.into());
        }
        let is_tested = is_sliced && self.host_depth;
        if (is_tested || self.gives_depth) && self.target.depth.is_none() {
            return Err(Error::HostDepth {
                wanted: "a depth attachment in `Class::target`".into(),
                found: "none".into(),
            });
        }
        if self.gives_depth && (is_sliced || !settings.mode.has_depth()) {
            return Err(Error::NoDepth { what: self.what() });
        }
        Ok(())
    }

    /// Technique and mode.
    pub(super) fn what(&self) -> String {
        what(&self.settings)
    }
}

/// As many frames in flight as a host may have.
pub(super) fn check_frames(found: u32) -> Result<(), Error> {
    match (1..=MOST_FRAMES).contains(&found) {
        true => Ok(()),
        false => Err(Error::FramesInFlight {
            found,
            most: MOST_FRAMES,
        }),
    }
}

/// Technique, mode and filter.
pub(super) fn what(settings: &Settings) -> String {
    let Settings {
        technique,
        mode,
        filter,
        ..
    } = settings;
    format!("{technique}, mode {mode}, filter {filter}")
}
