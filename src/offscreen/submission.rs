//! A picture's bricks in timed submissions, each a part of the picture.

use super::targets::Targets;
use super::time_slices::{Spent, TimeSlices, Work};
use crate::gpu::Blocks;
use crate::gpu::{Error, Gpu, Headless, Image, Tile, Timer, Use, image_barrier};
use crate::technique::{Inputs, Order, RayBindings};
use ash::vk;
use std::ops::Range;

/// The device, where it writes, what is drawn, its clock, and how it is cut.
#[derive(Debug)]
pub struct Submission<'a, 'v> {
    /// Submits and waits.
    pub device: &'a mut Headless,
    /// The images.
    pub targets: &'a Targets,
    /// In the order in which they are recorded.
    pub bricks: &'a [Part<'a>],
    /// The device's clock, if it has one.
    pub timer: Option<&'a Timer>,
    /// How work is cut.
    pub slices: &'a mut TimeSlices<'v>,
    /// What all of it will take.
    pub expected_ms: f64,
    /// Whether it is one of the passes that a picture takes: the watch is told how far it is.
    pub is_drawing: bool,
    /// The images hold what bricks before these have left, in [`Use::FragmentSampled`].
    pub resumes: bool,
}

/// What one brick adds to a picture.
#[derive(Debug)]
pub struct Part<'a> {
    /// What a technique reads.
    pub inputs: Inputs<'a>,
    /// Of the parameters in the ring.
    pub offset: u32,
    /// Slices to draw.
    pub slices: u32,
    /// How they are blended.
    pub order: Order,
    /// The pixels that it may change, where those are known; the first of several has to write all.
    pub seen: Option<Tile>,
}

/// What one submission draws: these pixels with all that they show.
#[derive(Debug)]
pub struct Tiles {
    /// The pixels.
    pub tiles: Vec<Tile>,
    /// Whether it is the first submission, and whether the last.
    pub is_first: bool,
    pub is_last: bool,
}

/// A block takes no more than this part of a submission.
const MOST_OF_A_BLOCK: f64 = 0.25;

impl Submission<'_, '_> {
    /// One descriptor set for each brick.
    pub fn bind<B>(&self, bind: impl Fn(&Inputs) -> Result<B, Error>) -> Result<Vec<B>, Error> {
        self.bricks
            .iter()
            .map(|brick| bind(&brick.inputs))
            .collect()
    }

    /// Into how many pieces something is cut that is so much of the whole.
    pub fn pieces(&self, part: f64) -> u32 {
        let allowed_ms = MOST_OF_A_BLOCK * self.slices.target_ms;
        // Not a number is one piece.
        (part * self.expected_ms / allowed_ms).ceil().max(1.0) as u32
    }

    /// Runs units of the picture in submissions that take part of them each.
    pub fn run(
        self,
        units: u64,
        record: impl FnMut(vk::CommandBuffer, &Gpu, Range<u64>) -> Result<(), Error>,
    ) -> Result<Spent, Error> {
        let Self {
            device,
            timer,
            slices,
            expected_ms,
            is_drawing,
            ..
        } = self;
        let work = Work {
            units: 0..units,
            expected_ms,
            is_drawing,
        };
        slices.run(device, timer, work, record)
    }

    /// Runs what `record` records for the pixels of each submission.
    pub fn in_tiles(
        self,
        record: impl Fn(vk::CommandBuffer, &Gpu, &Tiles) -> Result<(), Error>,
    ) -> Result<Spent, Error> {
        let extent = self.targets.extent;
        // As few as will do: each is a dispatch, or a rendering, that has an end to wait for.
        let rows = extent[1].div_ceil(Tile::STEP).max(1);
        let down = self.pieces(1.0).min(rows);
        let across = self.pieces(1.0 / f64::from(down));
        let blocks = Blocks::new(extent, [across, down]);
        let count = blocks.count();
        self.run(count, |cmd, gpu, part| {
            let drawn = Tiles {
                is_first: part.start == 0,
                is_last: part.end == count,
                tiles: blocks.tiles(part),
            };
            record(cmd, gpu, &drawn)
        })
    }

    /// Runs a compute pass over each brick, one after the other, that writes `images`; leaves them in
    /// [`Use::FragmentSampled`].
    pub fn compute(
        self,
        images: &[&Image],
        bound: &[RayBindings],
        record: impl Fn(vk::CommandBuffer, &RayBindings, u32, &[Tile]) -> Result<(), Error>,
    ) -> Result<Spent, Error> {
        let (bricks, resumes) = (self.bricks, self.resumes);
        self.in_tiles(|cmd, gpu, drawn| {
            let barriers = |before, after| {
                for image in images {
                    // SAFETY: outside rendering; the images live until `run` has waited.
                    unsafe { image_barrier(gpu, cmd, image, before, after) };
                }
            };
            let mut before = match (drawn.is_first, resumes) {
                (true, true) => Use::FragmentSampled,
                (true, false) => Use::Nothing,
                (false, _) => Use::ComputeWrite,
            };
            for (brick, bindings) in bricks.iter().zip(bound) {
                barriers(before, Use::ComputeWrite);
                let seen = |tile: &Tile| match brick.seen {
                    Some(seen) => tile.and(seen),
                    None => Some(*tile),
                };
                let tiles: Vec<_> = drawn.tiles.iter().filter_map(seen).collect();
                record(cmd, bindings, brick.offset, &tiles)?;
                before = Use::ComputeWrite;
            }
            if drawn.is_last {
                barriers(before, Use::FragmentSampled);
            }
            Ok(())
        })
    }
}
