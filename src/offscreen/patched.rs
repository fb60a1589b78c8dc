//! A slicer's picture where only some patches of its slices are drawn ([`PatchSlicer`]).

use super::slicing::Slicing;
use super::submission::{Part, Submission};
use super::time_slices::Spent;
use crate::gpu::{
    Error, Gpu, Image, Load, Use, begin_rendering, clear_image, end_rendering, image_barrier,
};
use crate::technique::blend::Drawn;
use crate::technique::merge::{MAX_BATCH_SLICES, Merge};
use crate::technique::slice_gather::batch_image;
use crate::technique::{BATCH_SLICES, Order, PatchBindings, PatchRoom, PatchSlicer, Patches};
use ash::vk;
use std::ops::Range;

/// One picture of patches.
struct Patched<'a> {
    slicer: &'a PatchSlicer,
    patches: &'a Patches,
    room: PatchRoom,
    extent: [u32; 2],
    /// What slices are blended in.
    target: &'a Image,
}

/// A brick and what is bound for it.
type Bound<'a, 'p> = (&'a Part<'p>, PatchBindings);

/// Draws all slices into `into` and leaves it in [`Use::FragmentSampled`]. Milliseconds on the device.
pub fn run(
    slicing: &Slicing,
    slicer: &PatchSlicer,
    merge: Option<&Merge>,
    submission: Submission,
    into: &Image,
) -> Result<Spent, Error> {
    let (bricks, targets) = (submission.bricks, submission.targets);
    let (patches, room) = targets.patches();
    let extent = targets.extent;
    let batch = merge.map(|_| batch_image(slicing.gpu(), extent));
    let batch = batch.transpose()?;
    let patched = Patched {
        slicer,
        patches,
        room,
        extent,
        target: batch.as_ref().unwrap_or(into),
    };
    let bind = |brick: &Part| slicer.bind(&brick.inputs, patches, Some(patched.target));
    let bound = bricks.iter().map(bind).collect::<Result<Vec<_>, Error>>()?;
    let bricks: Vec<Bound> = bricks.iter().zip(bound).collect();
    let steps: Vec<Step> = bricks
        .iter()
        .flat_map(|brick| steps_of(brick, merge))
        .collect();
    let count = steps.len().max(1) as u64;
    let part_of = |part: &Range<u64>| part.start as usize..(part.end as usize).min(steps.len());
    let Some(merge) = merge else {
        // SAFETY: recorded in order, with barriers between; `run` waits, and all that is bound lives meanwhile.
        return submission.run(count, |cmd, gpu, part| unsafe {
            if part.start == 0 {
                image_barrier(gpu, cmd, into, Use::Nothing, Use::ColorTarget);
            }
            patched.record(cmd, gpu, (&steps, part_of(&part)), slicing)?;
            if part.end == count {
                image_barrier(gpu, cmd, into, Use::ColorTarget, Use::FragmentSampled);
            }
            Ok(())
        });
    };
    let merged = merge.bind(patched.target, into)?;
    // SAFETY: as above.
    submission.run(count, |cmd, gpu, part| unsafe {
        if part.start == 0 {
            image_barrier(gpu, cmd, into, Use::Nothing, Use::TransferWrite);
            clear_image(gpu, cmd, into, [0.0; 4]);
            image_barrier(gpu, cmd, into, Use::TransferWrite, Use::ComputeWrite);
        }
        patched.record_merged(cmd, gpu, (&steps, part_of(&part)), merge, (&merged, into))?;
        if part.end == count {
            image_barrier(gpu, cmd, into, Use::ComputeWrite, Use::FragmentSampled);
        }
        Ok(())
    })
}

/// Slices that are drawn at once, and whether they are the first of their brick.
struct Step<'a, 'p> {
    brick: &'a Bound<'a, 'p>,
    slices: Range<u32>,
    is_first: bool,
}

// The same batches as of whole slices, and so the same picture.
const _: () = assert!(BATCH_SLICES == MAX_BATCH_SLICES);

/// Slices from back to front, of which nothing is asked between them, that are drawn at once.
const UNORDERED_SLICES: u32 = 4 * BATCH_SLICES;

fn steps_of<'a, 'p>(brick: &'a Bound<'a, 'p>, merge: Option<&Merge>) -> Vec<Step<'a, 'p>> {
    let (part, _) = brick;
    let is_in_batches = merge.is_some() || part.order == Order::FrontToBack;
    let at_once = match is_in_batches {
        true => BATCH_SLICES,
        false => UNORDERED_SLICES,
    };
    let step = |slices: Range<u32>| Step {
        brick,
        is_first: slices.start == 0,
        slices,
    };
    runs(part.slices, at_once).map(step).collect()
}

impl Patched<'_> {
    /// Records some of the steps of a picture.
    ///
    /// # Safety
    /// `cmd` is recording, outside rendering; the target is in `Use::ColorTarget`, in which it is left.
    unsafe fn record(
        &self,
        cmd: vk::CommandBuffer,
        gpu: &Gpu,
        (steps, part): (&[Step], Range<usize>),
        slicing: &Slicing,
    ) -> Result<(), Error> {
        let is_picture = slicing.drawn() != Drawn::Count;
        let clear = Load::Clear(slicing.clear());
        // SAFETY: the caller's promises; the target is in the use that its next access needs.
        unsafe {
            // What has been opaque in the picture is not counted either.
            if is_picture && part.start == 0 {
                self.patches.record_start(cmd);
            }
            for (number, step) in part.clone().zip(&steps[part.clone()]) {
                let (brick, bindings) = step.brick;
                if step.is_first {
                    self.list(cmd, brick, bindings)?;
                }
                let is_ordered = brick.order == Order::FrontToBack;
                let has_more = number > 0;
                let batch = number as u32 + 1;
                match (is_ordered, is_picture) {
                    (true, true) if has_more => {
                        self.find_opaque(cmd, gpu, brick, bindings, batch)?;
                    }
                    (true, false) => self.patches.record_batch(cmd, batch),
                    _ if has_more => {
                        let (target, same) = (self.target, Use::ColorTarget);
                        image_barrier(gpu, cmd, target, same, same);
                    }
                    _ => {}
                }
                let load = if has_more { Load::Keep } else { clear };
                self.draw(cmd, gpu, load, (brick, bindings), step.slices.clone());
            }
            if steps.is_empty() {
                begin_rendering(gpu, cmd, &[(self.target.view(), clear)], self.extent);
                end_rendering(gpu, cmd);
            }
        }
        Ok(())
    }

    /// The same by batches that `merge` lays onto what is in `into`, which is in `Use::ComputeWrite`.
    ///
    /// # Safety
    /// As above; nothing is in the target.
    unsafe fn record_merged(
        &self,
        cmd: vk::CommandBuffer,
        gpu: &Gpu,
        (steps, part): (&[Step], Range<usize>),
        merge: &Merge,
        (merged, into): (&crate::gpu::Bindings, &Image),
    ) -> Result<(), Error> {
        // SAFETY: the caller's promises; every image is in the use that its next access needs.
        unsafe {
            if part.start == 0 {
                self.patches.record_start(cmd);
            }
            for (number, step) in part.clone().zip(&steps[part.clone()]) {
                let (brick, bindings) = step.brick;
                if step.is_first {
                    self.list(cmd, brick, bindings)?;
                }
                let last = match number {
                    0 => Use::Nothing,
                    _ => Use::ComputeSampled,
                };
                image_barrier(gpu, cmd, self.target, last, Use::ColorTarget);
                let clear = Load::Clear([0.0; 4]);
                self.draw(cmd, gpu, clear, (brick, bindings), step.slices.clone());
                image_barrier(gpu, cmd, self.target, Use::ColorTarget, Use::ComputeSampled);
                merge.record(cmd, merged, self.extent)?;
                image_barrier(gpu, cmd, into, Use::ComputeWrite, Use::ComputeWrite);
            }
        }
        Ok(())
    }

    /// # Safety
    /// As [`Self::record`].
    unsafe fn list(
        &self,
        cmd: vk::CommandBuffer,
        brick: &Part,
        bindings: &PatchBindings,
    ) -> Result<(), Error> {
        let (squares, slices) = (self.room.squares, brick.slices);
        // SAFETY: the caller's promises.
        unsafe {
            self.slicer
                .record_lists(cmd, bindings, brick.offset, self.patches, squares, slices)
        }
    }

    /// # Safety
    /// As [`Self::record`].
    unsafe fn find_opaque(
        &self,
        cmd: vk::CommandBuffer,
        gpu: &Gpu,
        brick: &Part,
        bindings: &PatchBindings,
        batch: u32,
    ) -> Result<(), Error> {
        let (target, squares) = (self.target, self.room.squares);
        // SAFETY: the caller's promises; the target is read between two renderings.
        unsafe {
            image_barrier(gpu, cmd, target, Use::ColorTarget, Use::ComputeSampled);
            self.slicer
                .record_opaque(cmd, bindings, brick.offset, self.patches, squares, batch)?;
            image_barrier(gpu, cmd, target, Use::ComputeSampled, Use::ColorTarget);
        }
        Ok(())
    }

    /// # Safety
    /// As [`Self::record`].
    unsafe fn draw(
        &self,
        cmd: vk::CommandBuffer,
        gpu: &Gpu,
        load: Load,
        (brick, bindings): (&Part, &PatchBindings),
        slices: Range<u32>,
    ) {
        let (extent, patches) = (self.extent, self.patches);
        // SAFETY: the caller's promises.
        unsafe {
            begin_rendering(gpu, cmd, &[(self.target.view(), load)], extent);
            self.slicer
                .record(cmd, bindings, brick.offset, extent, patches, slices);
            end_rendering(gpu, cmd);
        }
    }
}

/// `slices` slices, so many at once.
fn runs(slices: u32, at_once: u32) -> impl Iterator<Item = Range<u32>> {
    let firsts = (0..slices).step_by(at_once as usize);
    firsts.map(move |first| first..first.saturating_add(at_once).min(slices))
}
