//! What one frame in flight has to itself: images, descriptor sets, and what was recorded for it.

use super::function::Function;
use super::pass::Pass;
use super::{Error, HostDepthImage, Volume};
use crate::camera::Camera;
use crate::gpu::{Bindings, Blocks, Buffer, Gpu, Image, Memory, ParameterRing, Resource};
use crate::resident::GpuVolume;
use crate::technique::{Inputs, accumulation};
use ash::vk;
use std::sync::Arc;

/// The texel of each of two images, four f32.
pub(super) const PICK_BYTES: u64 = 32;

/// What one frame in flight has to itself.
#[derive(Debug)]
pub(super) struct Frame {
    /// What a technique leaves, where that is no draw into the host's target; and what rays leave beside it.
    pub images: Option<[Image; 2]>,
    pub sets: Sets,
    /// Where the device puts the texels of a pixel.
    pub pick: Option<Buffer>,
    /// The pixel whose copy was recorded after the picture, and the camera of that.
    pub picked: Option<([u32; 2], Camera)>,
    /// What [`super::Renderer::draw`] draws.
    pub recorded: Option<Recorded>,
    /// What is being recorded part by part.
    pub begun: Option<Begun>,
}

/// A frame of which some blocks are recorded.
#[derive(Debug)]
pub(super) struct Begun {
    pub recorded: Recorded,
    pub blocks: Blocks,
    /// The first block that is not recorded.
    pub next: u64,
}

/// The descriptor sets of one frame in flight.
#[derive(Debug, Default)]
pub(super) struct Sets {
    /// Of each brick of each copy of the volume.
    pub bricks: Vec<Vec<Bindings>>,
    /// Of what makes colours of the images.
    pub resolve: Option<Bindings>,
    /// Of what writes their depth.
    pub depth: Option<Bindings>,
}

/// What was recorded last.
#[derive(Debug)]
pub(super) struct Recorded {
    pub camera: Camera,
    /// Which copy of the volume.
    pub copy: usize,
    pub parts: Vec<Part>,
}

/// One brick of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub brick: usize,
    /// Of its parameters.
    pub offset: u32,
    pub slices: u32,
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

impl Frame {
    /// Images of `extent` and descriptor sets.
    pub fn new(bound: &Bound, extent: [u32; 2]) -> Result<Self, Error> {
        let gpu = bound.gpu;
        let image = |name| accumulation(gpu, extent, name);
        let images = match bound.pass {
            Pass::Slices(_) => None,
            Pass::Rays { .. } | Pass::Projected { .. } => {
                Some([image("gathered")?, image("layers")?])
            }
        };
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let pick = match bound.pass {
            Pass::Rays { .. } => Some(Buffer::new(
                gpu,
                PICK_BYTES,
                usage,
                Memory::Readback,
                "picked texels",
            )?),
            Pass::Slices(_) | Pass::Projected { .. } => None,
        };
        let mut made = Self {
            images,
            sets: Sets::default(),
            pick,
            picked: None,
            recorded: None,
            begun: None,
        };
        made.sets = made.bind(bound)?;
        Ok(made)
    }

    /// Descriptor sets anew: of another transfer function, or of another depth buffer.
    pub fn bind(&self, bound: &Bound) -> Result<Sets, Error> {
        let copies = bound.volume.copies().iter();
        let of_copy = |copy: &GpuVolume| -> Result<Vec<Bindings>, Error> {
            (0..copy.bricks().len())
                .map(|brick| self.bind_brick(bound, copy, brick))
                .collect()
        };
        let mut sets = Sets {
            bricks: copies.map(of_copy).collect::<Result<_, _>>()?,
            ..Sets::default()
        };
        let transfer = bound.function.transfer();
        if let Some([gathered, layers]) = &self.images {
            let (resolve, depth) = match bound.pass {
                Pass::Rays {
                    pass,
                    resolve,
                    depth,
                } => {
                    let left = match pass {
                        crate::technique::RayPass::Raycast(_) => layers,
                        crate::technique::RayPass::Projection(_) => gathered,
                    };
                    (resolve, depth.as_ref().map(|depth| (depth, left)))
                }
                Pass::Projected { resolve, .. } => (resolve, None),
                Pass::Slices(_) => unreachable!("slices in the host's rendering leave no image"),
            };
            sets.resolve = Some(resolve.bind(bound.ring, gathered, transfer)?);
            let depth = depth.map(|(depth, left)| depth.bind(bound.ring, left));
            sets.depth = depth.transpose()?;
        }
        Ok(sets)
    }

    fn bind_brick(&self, bound: &Bound, copy: &GpuVolume, brick: usize) -> Result<Bindings, Error> {
        let inputs = Inputs {
            ring: bound.ring,
            volume: copy,
            brick: &copy.bricks()[brick],
            transfer: bound.function.transfer(),
            beside: &[],
            light: None,
            skip: bound.function.skip(bound.volume),
        };
        Ok(match (bound.pass, &self.images) {
            (Pass::Rays { pass, .. }, Some([gathered, layers])) => {
                let depth = bound.host_depth;
                let depth = depth.map(|image| Resource::Texture(image.view, image.layout));
                pass.bind(&inputs, gathered, layers, depth)?
            }
            (Pass::Slices(slicer) | Pass::Projected { slicer, .. }, _) => slicer.bind(&inputs)?,
            (Pass::Rays { .. }, None) => unreachable!("rays leave images"),
        })
    }
}
