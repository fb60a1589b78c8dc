//! A picture's bricks in timed submissions, each a part of the picture.

use super::passes::Finish;
use super::time_slices::{Spent, TimeSlices, Work};
use crate::gpu::{Blocks, Error, Gpu, Headless, Resource, Tile, Timer};
use crate::technique::Inputs;
use crate::technique::gather::{BrickPass, Canvas, Gather, PICTURE, Part, Player};
use ash::vk;
use std::ops::Range;

/// The device, its clock, and how work is cut.
#[derive(Debug)]
pub struct Submission<'a, 'v> {
    /// Submits and waits.
    pub device: &'a mut Headless,
    /// The device's clock, if it has one.
    pub timer: Option<&'a Timer>,
    /// How work is cut.
    pub slices: &'a mut TimeSlices<'v>,
    /// What all of it will take.
    pub expected_ms: f64,
    /// Whether it is one of the passes that a picture takes: the watch is told how far it is.
    pub is_drawing: bool,
    /// What is made of the picture behind its last part, in the same submission.
    pub finish: Option<&'a Finish<'a>>,
}

/// A block takes no more than this part of a submission.
const MOST_OF_A_BLOCK: f64 = 0.25;

impl Submission<'_, '_> {
    /// Into how many pieces something is cut that is so much of the whole.
    fn pieces(&self, part: f64) -> u32 {
        let allowed_ms = MOST_OF_A_BLOCK * self.slices.target_ms;
        // Not a number is one piece.
        (part * self.expected_ms / allowed_ms).ceil().max(1.0) as u32
    }

    /// Runs units of the picture in submissions that take part of them each.
    fn run(
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
            finish,
        } = self;
        let work = Work {
            units: 0..units,
            expected_ms,
            is_drawing,
            is_finished: finish.is_some(),
        };
        slices.run(device, timer, work, record)
    }

    /// Runs what `record` records for the pixels of each submission.
    pub fn in_tiles(
        self,
        extent: [u32; 2],
        mut record: impl FnMut(vk::CommandBuffer, &Gpu, &Part) -> Result<(), Error>,
    ) -> Result<Spent, Error> {
        // As few as will do: each is a dispatch, or a rendering, that has an end to wait for.
        let rows = extent[1].div_ceil(Tile::STEP).max(1);
        let down = self.pieces(1.0).min(rows);
        let across = self.pieces(1.0 / f64::from(down));
        let blocks = Blocks::new(extent, [across, down]);
        let count = blocks.count();
        self.run(count, |cmd, gpu, blocks_of| {
            let part = Part {
                is_first: blocks_of.start == 0,
                is_last: blocks_of.end == count,
                tiles: &blocks.tiles(blocks_of),
                steps: 0..0,
                bands: 1,
            };
            record(cmd, gpu, &part)
        })
    }

    /// Runs the passes of a technique over bricks, what is read of each beside what is recorded, into a canvas.
    /// `depth`: where rays end. `resumes`: onto what bricks before these have left there.
    pub fn gather(
        self,
        gather: &dyn Gather,
        canvas: &mut Canvas,
        (inputs, bricks): (&[Inputs], &[BrickPass]),
        depth: Option<Resource>,
        resumes: bool,
    ) -> Result<Spent, Error> {
        let bound = gather.bind(canvas, inputs, depth)?;
        match resumes {
            true => canvas.resume(),
            false => canvas.begin(),
        }
        // A slice of those that take steps is drawn twice.
        let slices: u32 = bricks.iter().map(|brick| brick.slices).sum();
        let bands = self.pieces(1.0 / f64::from(slices.max(1)));
        let finish = self.finish;
        let record = |cmd, gpu: &Gpu, canvas: &mut Canvas, part: &Part| {
            if let (Some(finish), [], true) = (finish, part.tiles, part.steps.is_empty()) {
                // SAFETY: as below; the last part has left the picture so.
                return unsafe { finish.record(cmd, gpu, canvas.image(PICTURE)) };
            }
            let mut player = Player { gpu, cmd, canvas };
            // SAFETY: recorded outside rendering, parts in order; `run` waits, and all that is bound lives meanwhile.
            unsafe { bound.record(&mut player, bricks, part) }
        };
        match bound.steps(canvas, bricks, bands) {
            None => self.in_tiles(canvas.extent(), |cmd, gpu, part| {
                record(cmd, gpu, canvas, part)
            }),
            Some(count) => self.run(count, |cmd, gpu, steps| {
                let part = Part {
                    tiles: &[],
                    is_first: steps.start == 0,
                    is_last: steps.end == count,
                    steps,
                    bands,
                };
                record(cmd, gpu, canvas, &part)
            }),
        }
    }
}
