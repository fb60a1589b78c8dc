//! A slicer's picture: drawn into the accumulation where the device blends f32, else in merged batches.

use super::patched;
use super::submission::Submission;
use super::time_slices::Spent;
use crate::gpu::{
    Bindings, Error, Gpu, Image, ImageDesc, ImageKind, Load, Use, begin_rendering_of, clear_image,
    end_rendering, image_barrier,
};
use crate::technique::blend::{Drawn, clear_color};
use crate::technique::merge::{BATCH_FORMAT, MAX_BATCH_SLICES, Merge, is_merged};
use crate::technique::{ACCUMULATION_FORMAT, PatchSlicer, Settings, Slicer, Words};
use ash::vk;
use std::sync::Arc;

/// The pipelines of one slicer.
#[derive(Debug)]
pub struct Slicing {
    gpu: Arc<Gpu>,
    drawn: Drawn,
    slicer: Slices,
    /// Where f32 targets cannot be blended.
    merge: Option<Merge>,
}

/// Which parts of slices are drawn.
#[derive(Debug)]
enum Slices {
    Whole(Slicer),
    Patches(Box<PatchSlicer>),
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
        let order = settings.order;
        let is_merged = is_merged(gpu, drawn);
        let format = if is_merged {
            BATCH_FORMAT
        } else {
            ACCUMULATION_FORMAT
        };
        let merge = || Merge::new(gpu, drawn, order);
        let technique = settings.technique;
        let slicer = match is_patched {
            true => {
                let made = PatchSlicer::new(gpu, technique, drawn, order, words, format)?;
                Slices::Patches(Box::new(made))
            }
            false => Slices::Whole(Slicer::new(gpu, technique, drawn, order, words, format)?),
        };
        Ok(Self {
            gpu: Arc::clone(gpu),
            drawn,
            slicer,
            merge: is_merged.then(merge).transpose()?,
        })
    }

    /// Draws all slices into `into` and leaves it in [`Use::FragmentSampled`]. Milliseconds on the device.
    pub fn run(&self, submission: Submission, into: &Image) -> Result<Spent, Error> {
        let slicer = match &self.slicer {
            Slices::Whole(slicer) => slicer,
            Slices::Patches(slicer) => return patched::run(self, slicer, submission, into),
        };
        let bound = submission.bind(|inputs| slicer.bind(inputs))?;
        match &self.merge {
            Some(merge) => self.run_in_batches(slicer, submission, &bound, into, merge),
            None => self.run_at_once(slicer, submission, &bound, into),
        }
    }

    pub(super) fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    pub(super) fn drawn(&self) -> Drawn {
        self.drawn
    }

    pub(super) fn merge(&self) -> Option<&Merge> {
        self.merge.as_ref()
    }

    /// What the target holds before the first slice.
    pub(super) fn clear(&self) -> [f32; 4] {
        match self.drawn {
            Drawn::Picture(mode) => clear_color(mode),
            Drawn::Count => [0.0; 4],
        }
    }

    fn run_at_once(
        &self,
        slicer: &Slicer,
        submission: Submission,
        bound: &[Bindings],
        into: &Image,
    ) -> Result<Spent, Error> {
        let (bricks, extent) = (submission.bricks, submission.targets.extent);
        let clear = self.clear();
        // SAFETY: recorded in order, with barriers between; `run` waits, and all that is bound lives meanwhile.
        submission.in_tiles(|cmd, gpu, drawn| unsafe {
            if drawn.is_first {
                image_barrier(gpu, cmd, into, Use::Nothing, Use::ColorTarget);
            }
            for &tile in &drawn.tiles {
                begin_rendering_of(gpu, cmd, &[(into.view(), Load::Clear(clear))], tile);
                for (brick, bindings) in bricks.iter().zip(bound) {
                    let (offset, slices) = (brick.offset, 0..brick.slices);
                    slicer.record_tile(cmd, bindings, offset, extent, slices, tile);
                }
                end_rendering(gpu, cmd);
            }
            if drawn.is_last {
                image_barrier(gpu, cmd, into, Use::ColorTarget, Use::FragmentSampled);
            }
            Ok(())
        })
    }

    fn run_in_batches(
        &self,
        slicer: &Slicer,
        submission: Submission,
        bound: &[Bindings],
        into: &Image,
        merge: &Merge,
    ) -> Result<Spent, Error> {
        let (bricks, extent) = (submission.bricks, submission.targets.extent);
        let batch = batch_image(&self.gpu, extent)?;
        let merged = merge.bind(&batch, into)?;
        let batches = bricks.iter().zip(bound).flat_map(|(brick, bindings)| {
            let firsts = (0..brick.slices).step_by(MAX_BATCH_SLICES as usize);
            let range = |first: u32| first..(first + MAX_BATCH_SLICES).min(brick.slices);
            firsts.map(move |first| (brick, bindings, range(first)))
        });
        // SAFETY: recorded in order, with barriers between; `run` waits, and all that is bound lives meanwhile.
        submission.in_tiles(|cmd, gpu, drawn| unsafe {
            let mut before = Use::ComputeWrite;
            if drawn.is_first {
                image_barrier(gpu, cmd, into, Use::Nothing, Use::TransferWrite);
                clear_image(gpu, cmd, into, [0.0; 4]);
                before = Use::TransferWrite;
            }
            let mut last = Use::Nothing;
            for (brick, bindings, slices) in batches.clone() {
                // What the merge before has read is overwritten only after it.
                image_barrier(gpu, cmd, &batch, last, Use::ColorTarget);
                last = Use::ComputeSampled;
                for &tile in &drawn.tiles {
                    let target = [(batch.view(), Load::Clear([0.0; 4]))];
                    begin_rendering_of(gpu, cmd, &target, tile);
                    let (offset, slices) = (brick.offset, slices.clone());
                    slicer.record_tile(cmd, bindings, offset, extent, slices, tile);
                    end_rendering(gpu, cmd);
                }
                image_barrier(gpu, cmd, &batch, Use::ColorTarget, Use::ComputeSampled);
                image_barrier(gpu, cmd, into, before, Use::ComputeWrite);
                for &tile in &drawn.tiles {
                    merge.record_tile(cmd, &merged, extent, tile)?;
                }
                before = Use::ComputeWrite;
            }
            if drawn.is_last {
                image_barrier(gpu, cmd, into, before, Use::FragmentSampled);
            }
            Ok(())
        })
    }
}

pub(super) fn batch_image(gpu: &Arc<Gpu>, [width, height]: [u32; 2]) -> Result<Image, Error> {
    let desc = ImageDesc {
        kind: ImageKind::D2,
        extent: [width, height, 1],
        format: BATCH_FORMAT,
        usage: vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::SAMPLED,
        name: "batch of slices",
    };
    Image::new(gpu, &desc)
}
