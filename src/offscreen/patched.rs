//! A slicer's picture where only some patches of its slices are drawn ([`PatchSlicer`]).

use super::slicing::{Slicing, batch_image};
use super::submission::{Part, Submission};
use crate::gpu::{
    Error, Gpu, Image, Load, Use, begin_rendering, clear_image, end_rendering, image_barrier,
};
use crate::technique::blend::Drawn;
use crate::technique::merge::Merge;
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
    submission: Submission,
    into: &Image,
) -> Result<Option<f64>, Error> {
    let (bricks, targets) = (submission.bricks, submission.targets);
    let (patches, room) = targets.patches();
    let extent = targets.extent;
    let batch = slicing.merge().map(|_| batch_image(slicing.gpu(), extent));
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
    let Some(merge) = slicing.merge() else {
        // SAFETY: recorded in order, with barriers between; `run` waits, and all that is bound lives meanwhile.
        return submission.run(|cmd, gpu| unsafe {
            image_barrier(gpu, cmd, into, Use::Nothing, Use::ColorTarget);
            patched.record(cmd, gpu, &bricks, slicing)?;
            image_barrier(gpu, cmd, into, Use::ColorTarget, Use::FragmentSampled);
            Ok(())
        });
    };
    let merged = merge.bind(patched.target, into)?;
    // SAFETY: as above.
    submission.run(|cmd, gpu| unsafe {
        image_barrier(gpu, cmd, into, Use::Nothing, Use::TransferWrite);
        clear_image(gpu, cmd, into, [0.0; 4]);
        image_barrier(gpu, cmd, into, Use::TransferWrite, Use::ComputeWrite);
        patched.record_merged(cmd, gpu, &bricks, merge, (&merged, into))?;
        image_barrier(gpu, cmd, into, Use::ComputeWrite, Use::FragmentSampled);
        Ok(())
    })
}

impl Patched<'_> {
    /// # Safety
    /// `cmd` is recording, outside rendering; the target is in `Use::ColorTarget`, in which it is left.
    unsafe fn record(
        &self,
        cmd: vk::CommandBuffer,
        gpu: &Gpu,
        bricks: &[Bound],
        slicing: &Slicing,
    ) -> Result<(), Error> {
        let is_picture = slicing.drawn() != Drawn::Count;
        let mut load = Load::Clear(slicing.clear());
        let mut batch = 0;
        // SAFETY: the caller's promises; the target is in the use that its next access needs.
        unsafe {
            // What has been opaque in the picture is not counted either.
            if is_picture {
                self.patches.record_start(cmd);
            }
            for (brick, bindings) in bricks {
                self.list(cmd, brick, bindings)?;
                let is_ordered = brick.order == Order::FrontToBack;
                let at_once = if is_ordered { BATCH_SLICES } else { u32::MAX };
                for slices in runs(brick.slices, at_once) {
                    batch += 1;
                    let has_more = load == Load::Keep;
                    match (is_ordered, is_picture) {
                        (true, true) if has_more => {
                            self.find_opaque(cmd, gpu, brick, bindings, batch)?
                        }
                        (true, false) => self.patches.record_batch(cmd, batch),
                        _ if has_more => {
                            image_barrier(
                                gpu,
                                cmd,
                                self.target,
                                Use::ColorTarget,
                                Use::ColorTarget,
                            );
                        }
                        _ => {}
                    }
                    self.draw(cmd, gpu, load, (brick, bindings), slices);
                    load = Load::Keep;
                }
            }
            if load != Load::Keep {
                begin_rendering(gpu, cmd, &[(self.target.view(), load)], self.extent);
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
        bricks: &[Bound],
        merge: &Merge,
        (merged, into): (&crate::gpu::Bindings, &Image),
    ) -> Result<(), Error> {
        let mut last = Use::Nothing;
        // SAFETY: the caller's promises; every image is in the use that its next access needs.
        unsafe {
            self.patches.record_start(cmd);
            for (brick, bindings) in bricks {
                self.list(cmd, brick, bindings)?;
                for slices in runs(brick.slices, BATCH_SLICES) {
                    image_barrier(gpu, cmd, self.target, last, Use::ColorTarget);
                    self.draw(cmd, gpu, Load::Clear([0.0; 4]), (brick, bindings), slices);
                    image_barrier(gpu, cmd, self.target, Use::ColorTarget, Use::ComputeSampled);
                    merge.record(cmd, merged, self.extent)?;
                    image_barrier(gpu, cmd, into, Use::ComputeWrite, Use::ComputeWrite);
                    last = Use::ComputeSampled;
                }
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
