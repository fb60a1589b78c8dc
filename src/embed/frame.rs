//! What one frame in flight has to itself: images, descriptor sets, and what was recorded for it.

use super::function::Function;
use super::pass::Pass;
use super::paths::Traced;
use super::{Error, HostDepthImage, Volume};
use crate::camera::Camera;
use crate::gpu::{Bindings, Blocks, Buffer, Gpu, Memory, ParameterRing, Resource};
use crate::resident::GpuVolume;
use crate::technique::gather::{Bound, BrickPass, Canvas, CanvasDesc, PICTURE};
use crate::technique::shear_warp::intermediate_room;
use crate::technique::{Inputs, Settings};
use ash::vk;
use std::sync::Arc;

/// The texel of each of two images, four f32.
pub(super) const PICK_BYTES: u64 = 32;

/// What one frame in flight has to itself.
#[derive(Debug)]
pub(super) struct Frame {
    /// What the picture is gathered in, where it is not drawn into the host's target and does not go on from frame to frame.
    pub picture: Option<Canvas>,
    /// What rays leave that look for the depth of slices.
    pub slice_depth: Option<Canvas>,
    pub sets: Sets,
    /// Where the device puts the texels of a pixel.
    pub pick: Option<Buffer>,
    /// The pixel whose copy was recorded after the picture, and the camera of that.
    pub picked: Option<([u32; 2], Camera)>,
    /// What [`super::Renderer::draw`] draws.
    pub recorded: Recorded,
    /// What is being recorded part by part.
    pub begun: Option<Begun>,
}

/// A frame of which some is recorded.
#[derive(Debug)]
pub(super) struct Begun {
    pub recorded: Recorded,
    pub cut: Cut,
    /// The first block or step that is not recorded.
    pub next: u64,
    /// How often the volume was updated before.
    pub after: u64,
    /// What the picture is thought to take.
    pub expected_ms: f64,
}

/// How a picture is cut.
#[derive(Debug)]
pub(super) enum Cut {
    Blocks(Blocks),
    /// What is no sum of blocks: so many steps, each in so many bands.
    Steps {
        count: u64,
        bands: u32,
    },
}

impl Cut {
    pub fn count(&self) -> u64 {
        match self {
            Self::Blocks(blocks) => blocks.count(),
            Self::Steps { count, .. } => *count,
        }
    }
}

/// The descriptor sets of one frame in flight, those of bricks for each copy of the volume.
#[derive(Debug, Default)]
pub(super) struct Sets {
    pub picture: Vec<Box<dyn Bound>>,
    pub slice_depth: Vec<Box<dyn Bound>>,
    pub in_target: Vec<Vec<Bindings>>,
    /// Of what makes colours of the images.
    pub resolve: Option<Bindings>,
    /// Of what writes their depth.
    pub depth: Option<Bindings>,
}

/// What was recorded last. Vectors keep their room from frame to frame.
#[derive(Debug, Default)]
pub(super) struct Recorded {
    /// The camera, and which copy of the volume. `None`: nothing that may be drawn.
    pub shot: Option<(Camera, usize)>,
    /// What the picture is the mean of, where it is one of paths.
    pub traced: Option<Traced>,
    /// Bricks in the order of the picture.
    pub picture: Vec<BrickPass>,
    /// Bricks of the depth of slices, from front to back.
    pub depth: Vec<BrickPass>,
    /// For sorting.
    pub order: Vec<usize>,
}

/// What descriptor sets name.
#[derive(Clone, Copy, Debug)]
pub(super) struct Given<'a> {
    pub gpu: &'a Arc<Gpu>,
    pub settings: &'a Settings,
    pub pass: &'a Pass,
    pub ring: &'a ParameterRing,
    pub volume: &'a Volume,
    pub function: &'a Function,
    pub host_depth: Option<HostDepthImage>,
    /// Of a picture of the sky.
    pub sky: Option<&'a Buffer>,
    /// What all frames add up in, where they do.
    pub mean: Option<&'a Canvas>,
}

impl Recorded {
    /// Room for so many.
    pub fn with_room(recordings: usize) -> Self {
        Self {
            shot: None,
            traced: None,
            picture: Vec::with_capacity(recordings),
            depth: Vec::with_capacity(recordings),
            order: Vec::with_capacity(recordings),
        }
    }
}

/// How large frames are, and what they keep.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrameSize {
    pub extent: [u32; 2],
    /// Of all that is recorded for one frame.
    pub recordings: usize,
    /// Whether depth is asked for, or bricks go on where others have ended.
    pub keeps_layers: bool,
    /// Whether pixels are picked from.
    pub is_picked: bool,
}

impl Given<'_> {
    /// What a canvas is made for, beside that of another frame.
    pub fn canvas<'c>(&self, size: FrameSize, beside: Option<&'c Canvas>) -> CanvasDesc<'c> {
        let grid = self.volume.grid();
        CanvasDesc {
            extent: size.extent,
            dims: grid.dims,
            intermediate_room: intermediate_room(grid, self.settings, size.extent),
            keeps_layers: size.keeps_layers,
            beside,
        }
    }
}

impl Frame {
    /// Images and descriptor sets; lists that no frame leaves behind are shared with the first one.
    pub fn new(given: &Given, size: FrameSize, first: Option<&Self>) -> Result<Self, Error> {
        let pass = given.pass;
        let of_picture = given.canvas(size, first.and_then(|frame| frame.picture.as_ref()));
        let picture = pass.picture.as_ref().filter(|_| given.mean.is_none());
        let of_depth = given.canvas(size, first.and_then(|frame| frame.slice_depth.as_ref()));
        let slice_depth = pass.slice_depth.as_ref();
        let readback = || {
            let usage = vk::BufferUsageFlags::TRANSFER_DST;
            Buffer::new(
                given.gpu,
                PICK_BYTES,
                usage,
                Memory::Readback,
                "picked texels",
            )
        };
        let mut made = Self {
            picture: picture
                .map(|gather| gather.canvas(&of_picture))
                .transpose()?,
            slice_depth: slice_depth
                .map(|gather| gather.canvas(&of_depth))
                .transpose()?,
            sets: Sets::default(),
            pick: size.is_picked.then(readback).transpose()?,
            picked: None,
            recorded: Recorded::with_room(size.recordings),
            begun: None,
        };
        made.sets = made.bind(given)?;
        Ok(made)
    }

    /// What the depth of the picture is in.
    pub fn depth_canvas(&self) -> Option<&Canvas> {
        self.slice_depth.as_ref().or(self.picture.as_ref())
    }

    /// Descriptor sets anew: of another transfer function, or of another depth buffer.
    pub fn bind(&self, given: &Given) -> Result<Sets, Error> {
        let pass = given.pass;
        let depth = given.host_depth;
        let depth = depth.map(|image| Resource::Texture(image.view, image.layout));
        let picture = given.mean.or(self.picture.as_ref());
        let mut sets = Sets::default();
        for copy in given.volume.copies() {
            let bricks = 0..copy.bricks().len();
            let bricks: Vec<_> = bricks.map(|brick| inputs(given, copy, brick)).collect();
            if let (Some(gather), Some(canvas)) = (&pass.picture, picture) {
                sets.picture.push(gather.bind(canvas, &bricks, depth)?);
            }
            if let (Some(gather), Some(canvas)) = (&pass.slice_depth, &self.slice_depth) {
                sets.slice_depth.push(gather.bind(canvas, &bricks, depth)?);
            }
            if let Some(slicer) = &pass.in_target {
                let bound = bricks.iter().map(|inputs| slicer.bind(inputs));
                sets.in_target.push(bound.collect::<Result<_, _>>()?);
            }
        }
        if let (Some(resolve), Some(canvas)) = (&pass.resolve, picture) {
            let (shown, transfer) = (canvas.image(PICTURE), given.function.transfer());
            sets.resolve = Some(resolve.bind(given.ring, shown, transfer)?);
        }
        let depth_image = self
            .depth_canvas()
            .and_then(|canvas| canvas.images().last());
        if let (Some(depth), Some(image)) = (&pass.depth, depth_image) {
            sets.depth = Some(depth.bind(given.ring, image)?);
        }
        Ok(sets)
    }
}

fn inputs<'a>(given: &Given<'a>, copy: &'a GpuVolume, brick: usize) -> Inputs<'a> {
    Inputs {
        ring: given.ring,
        volume: copy,
        brick: &copy.bricks()[brick],
        transfer: given.function.transfer(),
        beside: &[],
        light: None,
        points: None,
        field: None,
        sky: given.sky,
        skip: given.function.skip(given.volume),
    }
}
