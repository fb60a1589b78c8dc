//! What a renderer is made for, and what may be another thing in each frame.

use super::Error;
use crate::camera::{Camera, HostDepth};
use crate::gpu::TargetClass;
use crate::picture::Tone;
use crate::technique::{self, DepthAccess, Mode, Order, Settings, SkipBy};
use ash::vk;

/// What a renderer is made for: all that pipelines and images depend on.
#[derive(Clone, Debug)]
pub struct RendererDesc {
    /// What to compute. Numbers of it may change later ([`super::Renderer::set_settings`]), kinds may not.
    pub settings: Settings,
    /// What is drawn into: the formats, samples and depth of the host's rendering.
    pub target: TargetClass,
    /// How many frames of the host may be unfinished at once.
    pub frames_in_flight: u32,
    /// Whether what the host has drawn hides the volume: each [`FrameInfo`] says its [`HostDepth`] then. Its depth is read
    /// from images ([`HostDepthImage`]); slices that are blended in the target are tested against the attachment of
    /// `target` instead ([`RendererDesc::reads_host_depth`]).
    pub host_depth: bool,
    /// Whether depth is given back by [`super::Renderer::draw_depth`], where `target` has a depth attachment. Pixels can
    /// be picked from then as with `picks`.
    pub gives_depth: bool,
    /// Whether pixels are picked from ([`super::Renderer::record_pick`]). Rays that composite keep another image for it,
    /// 16 bytes a pixel and frame in flight; of slices, rays look for the depth.
    pub picks: bool,
    /// Where slices are blended with each other.
    pub slice_blending: SliceBlending,
}

/// Where slices are blended with each other (`sampling.md` 5).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SliceBlending {
    /// In an image of the renderer's with four 32-bit floats a pixel, or in batches of 16-bit floats that are merged in
    /// 32 bits where the device does not blend those; the result is blended once into the target, whatever its format.
    #[default]
    Float,
    /// One by one in the target, as early slicers did: composites from back to front alone. **Wrong in targets of few
    /// bits**: each slice is rounded to the target's format, so that 256 slices of opacity .001 give an opacity of .226
    /// in 32-bit floats and of 0 in 8 bits. It needs no image of its own, and tests each sample of a multisampled
    /// target against the host's depth. Not drawn in parts.
    InTarget,
}

/// Frames in flight: more than any host has.
pub(super) const MOST_FRAMES: u32 = 64;

/// A host's depth buffer as shaders read it: one level, one layer, one sample, with `SAMPLED` usage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HostDepthImage {
    pub(super) view: vk::ImageView,
    pub(super) layout: vk::ImageLayout,
    pub(super) extent: [u32; 2],
}

impl HostDepthImage {
    /// A 2D view of its depth aspect; the layout that it is in when what [`super::Renderer::record`] records runs,
    /// visible to sampled reads of the compute stage by rays, and of the fragment stage too by slices; its size, which
    /// is that of the picture.
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
pub struct FrameInfo<'a> {
    /// Which of the frames in flight: nothing unfinished was recorded with this number.
    pub frame: u32,
    /// The eye.
    pub camera: &'a Camera,
    /// The host's clip space, of the same matrices as the camera: wanted where [`RendererDesc::host_depth`] or
    /// [`RendererDesc::gives_depth`] is true, and else of no use.
    pub depth: Option<HostDepth>,
}

impl RendererDesc {
    /// Refuses by name what is not drawn inside a host's frame.
    pub(super) fn check(&self) -> Result<(), Error> {
        let settings = &self.settings;
        let (path, traces) = (&settings.path, settings.technique.traces_paths());
        let is_sliced = !settings.technique.casts_rays();
        let is_in_target = self.slice_blending == SliceBlending::InTarget;
        let refused = [
            (
                settings.splat.of_points || settings.field.is_some(),
                "scattered points",
                "draw their picture by `offscreen::Renderer`",
            ),
            (
                traces && (path.noise.is_some() || path.seconds.is_some()),
                "path tracing that ends by itself",
                "record frames for as long as it should go on",
            ),
            (
                traces && path.denoise,
                "path tracing with `PathTracing::denoise`",
                "draw its picture by `offscreen::Renderer`",
            ),
            (
                traces && self.finds_depth(),
                "the depth of path tracing",
                "its pixels are means of paths, which have no one depth",
            ),
            (
                traces && self.host_depth && (path.lens.is_some() || path.shows_sky),
                "path tracing with a lens, or before its sky, behind what a host has drawn",
                "the host draws the sky, and all is sharp",
            ),
            (
                settings.wants_light_volume(),
                "a picture with a light volume (shadows, ambient occlusion, light that scatters once out of a grid or a sky)",
                "take `technique::LightVolume` and record it",
            ),
            (
                settings.rays_per_side > 1,
                "a picture of several rays a pixel",
                "add up pictures of `View::in_pixel`",
            ),
            (
                settings.is_half_angle() && (self.host_depth || self.finds_depth()),
                "half-angle slicing behind what a host has drawn, or with its depth",
                "its slices face neither eye nor light: take rays",
            ),
            (
                settings.technique.is_warped() && (self.host_depth || self.finds_depth()),
                "shear-warp behind what a host has drawn, or with its depth",
                "its pixels are means of four rays, which have no one depth: take ray casting",
            ),
            (
                settings.adaptive_steps.is_some(),
                "a picture with adaptive steps",
                "take the step that it needs, or `EmptySpace::with_alike` and record it",
            ),
            (
                settings.empty_space != SkipBy::Cells,
                "empty space by an octree or by runs",
                "macro cells are made anew on the device where data or function change: take them",
            ),
            (
                settings.smooth,
                "a cross-fade of two stacks",
                "draw each of `slices_2d::stack_shares`",
            ),
            (
                is_in_target && !is_sliced,
                "a picture by rays that blends slices in the target",
                "take `SliceBlending::Float`",
            ),
            (
                is_in_target && settings.mode != Mode::Composite,
                "a mode other than composite by slices that are blended in the target",
                "take `SliceBlending::Float`",
            ),
            (
                is_in_target && settings.is_half_angle(),
                "half-angle slicing that blends slices in the target",
                "eye and light see its slices in turn: take `SliceBlending::Float`",
            ),
            (
                is_in_target && settings.preintegrated && self.host_depth,
                "pre-integrated slices in the target behind what a host has drawn",
                "its depth may lie inside a slab: take `SliceBlending::Float`",
            ),
            (
                is_in_target && settings.tone != Tone::default(),
                "tone mapping of slices that are blended in the target",
                "there are slices, and no picture yet: take `SliceBlending::Float`",
            ),
            (
                is_in_target && settings.order == Order::FrontToBack,
                "slicing from front to back in the target",
                "what a host has drawn lies behind: take `Order::BackToFront` or `SliceBlending::Float`",
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
        let is_tested = is_in_target && self.host_depth;
        let is_written = !is_sliced && self.gives_depth;
        if (is_tested || is_written) && self.target.depth.is_none() {
            return Err(Error::HostDepth {
                wanted: "a depth attachment in `RendererDesc::target`".into(),
                found: "none".into(),
            });
        }
        if self.finds_depth() && !settings.mode.has_depth() {
            return Err(Error::NoDepth { what: self.what() });
        }
        Ok(())
    }

    /// Whether the renderer reads the host's depth from images.
    pub fn reads_host_depth(&self) -> bool {
        let has_rays = self.settings.technique.casts_rays() || self.finds_depth();
        self.host_depth && (has_rays || self.gathers())
    }

    /// Whether slices are gathered in an image of our own.
    pub(super) fn gathers(&self) -> bool {
        let is_sliced = !self.settings.technique.casts_rays();
        is_sliced && self.slice_blending == SliceBlending::Float
    }

    /// What hides samples of slices.
    pub(super) fn depth_access(&self) -> DepthAccess {
        match self.host_depth {
            false => DepthAccess::None,
            true => DepthAccess::behind(&self.settings),
        }
    }

    /// Whether the depth of the picture is kept.
    pub(super) fn finds_depth(&self) -> bool {
        self.gives_depth || self.picks
    }

    /// Whether [`super::Renderer::draw_depth`] may be called.
    pub(super) fn draws_depth(&self) -> bool {
        self.gives_depth && self.target.depth.is_some()
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
