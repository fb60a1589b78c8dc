//! A slicer's picture: drawn into the accumulation where the device blends f32, else in merged batches.

use super::patched;
use super::submission::Submission;
use super::time_slices::Spent;
use crate::gpu::{Error, Gpu, Image};
use crate::technique::blend::Drawn;
use crate::technique::merge::Merge;
use crate::technique::slice_gather::{
    BrickSlices, GatherInto, PicturePart, SliceGather, blend_format, clear_of,
};
use crate::technique::{PatchSlicer, Settings, Sight, Words};
use std::sync::Arc;

/// The pipelines of one slicer.
#[derive(Debug)]
pub struct Slicing {
    gpu: Arc<Gpu>,
    drawn: Drawn,
    slicer: Slices,
}

/// Which parts of slices are drawn.
#[derive(Debug)]
enum Slices {
    Whole(Box<SliceGather>),
    Patches(Box<PatchSlicer>, Option<Merge>),
}

impl Slicing {
    /// Compiles; `is_patched`: for targets with patches.
    ///
    /// # Errors
    /// Where the mode needs f32 blending and the device has none.
    pub fn new(
        gpu: &Arc<Gpu>,
        settings: &Settings,
        drawn: Drawn,
        words: &Words,
        is_patched: bool,
    ) -> Result<Self, Error> {
        let slicer = match is_patched {
            true => {
                let (technique, order) = (settings.technique, settings.order);
                let (format, is_merged) = blend_format(gpu, drawn);
                let made = PatchSlicer::new(gpu, technique, drawn, order, words, format)?;
                let merge = || Merge::new(gpu, drawn, order);
                Slices::Patches(Box::new(made), is_merged.then(merge).transpose()?)
            }
            false => {
                let made = SliceGather::new(gpu, settings, drawn, words, Sight::Open)?;
                Slices::Whole(Box::new(made))
            }
        };
        Ok(Self {
            gpu: Arc::clone(gpu),
            drawn,
            slicer,
        })
    }

    /// Draws all slices into `into` and leaves it in [`Use::FragmentSampled`](crate::gpu::Use::FragmentSampled).
    /// Milliseconds on the device.
    pub fn run(&self, submission: Submission, into: &Image) -> Result<Spent, Error> {
        match &self.slicer {
            Slices::Whole(slices) => run_whole(slices, submission, into),
            Slices::Patches(slicer, merge) => {
                patched::run(self, slicer, merge.as_ref(), submission, into)
            }
        }
    }

    pub(super) fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    pub(super) fn drawn(&self) -> Drawn {
        self.drawn
    }

    /// What the target holds before the first slice.
    pub(super) fn clear(&self) -> [f32; 4] {
        clear_of(self.drawn)
    }
}

fn run_whole(slices: &SliceGather, submission: Submission, into: &Image) -> Result<Spent, Error> {
    let bound = submission.bind(|inputs| slices.bind(inputs, None))?;
    let images = slices.images(into)?;
    let into = GatherInto {
        accumulation: into,
        images: &images,
        host_depth: None,
        extent: submission.targets.extent,
    };
    let bricks = submission.bricks.iter().zip(&bound);
    let bricks = bricks.map(|(brick, bindings)| BrickSlices {
        bindings,
        offset: brick.offset,
        slices: brick.slices,
    });
    // SAFETY: recorded in order; `run` waits, and all that is bound lives meanwhile.
    submission.in_tiles(|cmd, _, drawn| unsafe {
        let part = PicturePart {
            tiles: &drawn.tiles,
            is_first: drawn.is_first,
            is_last: drawn.is_last,
        };
        slices.record(cmd, bricks.clone(), into, part)
    })
}
