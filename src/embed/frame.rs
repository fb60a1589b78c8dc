//! What one frame in flight has to itself: images, descriptor sets, and what was recorded for it.

use super::function::Function;
use super::pass::{Pass, Slices};
use super::{Error, HostDepthImage, Volume};
use crate::camera::Camera;
use crate::gpu::{Bindings, Blocks, Buffer, Gpu, Image, Memory, ParameterRing, Resource};
use crate::resident::GpuVolume;
use crate::technique::slice_gather::GatherImages;
use crate::technique::slices_3d::half_angle::{
    HalfAngleBindings, Steps, light_buffer, light_extent,
};
use crate::technique::{Inputs, Order, RayBindings, RayTiles, accumulation};
use ash::vk;
use std::sync::Arc;

/// The texel of each of two images, four f32.
pub(super) const PICK_BYTES: u64 = 32;

/// What one frame in flight has to itself.
#[derive(Debug)]
pub(super) struct Frame {
    /// What slices are gathered in, where they are not drawn into the host's target.
    pub gathered: Option<Image>,
    /// What slices are drawn into beside that.
    pub gather: Option<GatherImages>,
    /// What the light sees of half-angle slices.
    pub light: Option<Image>,
    /// What rays leave, the one with the depth last.
    pub left: Vec<Image>,
    /// Which tiles rays draw.
    pub tiles: Option<RayTiles>,
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
    /// Half-angle slices, which are no sum of blocks: eye and light take turns over all of the picture.
    Steps(Steps),
}

impl Cut {
    pub fn count(&self) -> u64 {
        match self {
            Self::Blocks(blocks) => blocks.count(),
            Self::Steps(steps) => steps.count(),
        }
    }
}

/// The descriptor sets of one frame in flight, those of bricks for each copy of the volume.
#[derive(Debug, Default)]
pub(super) struct Sets {
    pub slices: Vec<Vec<Bindings>>,
    /// Of what copies the host's depth for slices to be tested against.
    pub host_depth: Option<Bindings>,
    /// Of half-angle slices, which have one brick of one copy.
    pub half_angle: Option<HalfAngleBindings>,
    pub rays: Vec<Vec<RayBindings>>,
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
    /// Bricks in the order of the picture.
    pub picture: Vec<Part>,
    /// Bricks of the depth of slices, from front to back.
    pub depth: Vec<Part>,
    /// For sorting.
    pub order: Vec<usize>,
}

/// One brick of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub brick: usize,
    /// Of its parameters.
    pub offset: u32,
    pub slices: u32,
    pub order: Order,
}

/// What descriptor sets name.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bound<'a> {
    pub gpu: &'a Arc<Gpu>,
    pub pass: &'a Pass,
    pub ring: &'a ParameterRing,
    pub volume: &'a Volume,
    pub function: &'a Function,
    pub host_depth: Option<HostDepthImage>,
}

impl Recorded {
    /// Room for so many.
    pub fn with_room(recordings: usize) -> Self {
        Self {
            shot: None,
            picture: Vec::with_capacity(recordings),
            depth: Vec::with_capacity(recordings),
            order: Vec::with_capacity(recordings),
        }
    }
}

impl Frame {
    /// Images of `extent` and descriptor sets, with room for so many recordings.
    pub fn new(bound: &Bound, extent: [u32; 2], recordings: usize) -> Result<Self, Error> {
        let (gpu, pass) = (bound.gpu, bound.pass);
        let image = |name: &str| accumulation(gpu, extent, name);
        let is_gathered =
            matches!(pass.slices, Some(Slices::Gathered(_))) || pass.half_angle.is_some();
        let of_light = || light_buffer(gpu, light_extent(bound.volume.grid(), extent));
        let light = pass.half_angle.is_some().then(of_light).transpose()?;
        let gathered = is_gathered.then(|| image("slices")).transpose()?;
        let gather = match (&pass.slices, &gathered) {
            (Some(Slices::Gathered(slices)), Some(image)) => Some(slices.images(image)?),
            _ => None,
        };
        let of_rays = pass.rays.as_ref().map_or(0, |rays| rays.image_count());
        let left = ["rays", "beside rays"].into_iter().take(of_rays).map(image);
        let tiles = pass.rays.is_some().then(|| RayTiles::new(gpu, extent));
        let readback = || {
            let usage = vk::BufferUsageFlags::TRANSFER_DST;
            Buffer::new(gpu, PICK_BYTES, usage, Memory::Readback, "picked texels")
        };
        let mut made = Self {
            gathered,
            gather,
            light,
            left: left.collect::<Result<_, _>>()?,
            tiles: tiles.transpose()?,
            sets: Sets::default(),
            pick: pass.rays.is_some().then(readback).transpose()?,
            picked: None,
            recorded: Recorded::with_room(recordings),
            begun: None,
        };
        made.sets = made.bind(bound)?;
        Ok(made)
    }

    /// Descriptor sets anew: of another transfer function, or of another depth buffer.
    pub fn bind(&self, bound: &Bound) -> Result<Sets, Error> {
        let pass = bound.pass;
        let depth = bound.host_depth;
        let depth = depth.map(|image| Resource::Texture(image.view, image.layout));
        let mut sets = Sets::default();
        match &pass.slices {
            Some(Slices::Gathered(slices)) => {
                sets.slices = of_bricks(bound, |inputs| slices.bind(inputs, depth))?;
                let depth = depth.map(|depth| slices.bind_host_depth(bound.ring, depth));
                sets.host_depth = depth.transpose()?.flatten();
            }
            Some(Slices::InTarget(slicer)) => {
                sets.slices = of_bricks(bound, |inputs| slicer.bind(inputs))?;
            }
            None => {}
        }
        if let (Some(slicer), Some(light)) = (&pass.half_angle, &self.light) {
            let inputs = inputs(bound, &bound.volume.copies()[0], 0);
            sets.half_angle = Some(slicer.bind(&inputs, light)?);
        }
        if let (Some(rays), Some(tiles)) = (&pass.rays, &self.tiles)
            && let [first, .., last] | [first @ last] = &self.left[..]
        {
            sets.rays = of_bricks(bound, |inputs| rays.bind(inputs, first, last, tiles, depth))?;
        }
        let shown = self.gathered.as_ref().or(self.left.first());
        if let (Some(resolve), Some(shown)) = (&pass.resolve, shown) {
            sets.resolve = Some(resolve.bind(bound.ring, shown, bound.function.transfer())?);
        }
        if let (Some(depth), Some(last)) = (&pass.depth, self.left.last()) {
            sets.depth = Some(depth.bind(bound.ring, last)?);
        }
        Ok(sets)
    }
}

/// Those of all bricks of each copy.
fn of_bricks<B>(
    bound: &Bound,
    bind: impl Fn(&Inputs) -> Result<B, crate::gpu::Error>,
) -> Result<Vec<Vec<B>>, crate::gpu::Error> {
    let copies = bound.volume.copies().iter();
    let of_copy = |copy: &GpuVolume| {
        let bricks = 0..copy.bricks().len();
        bricks
            .map(|brick| bind(&inputs(bound, copy, brick)))
            .collect()
    };
    copies.map(of_copy).collect()
}

fn inputs<'a>(bound: &Bound<'a>, copy: &'a GpuVolume, brick: usize) -> Inputs<'a> {
    Inputs {
        ring: bound.ring,
        volume: copy,
        brick: &copy.bricks()[brick],
        transfer: bound.function.transfer(),
        beside: &[],
        light: None,
        skip: bound.function.skip(bound.volume),
    }
}
