//! Slices of which only some patches are drawn ([`PatchSlicer`]).
//!
//! ```text
//! for each brick:
//!     list                   the patches in which something is seen
//!     for each batch of its slices:
//!         opaque             from front to back: squares of the picture that are opaque by now are left out
//!         draw               the patches of the batch; where halves are blended, into an image of their own
//!         merge              that image into the picture, in f32
//! ```

use super::super::blend::Drawn;
use super::super::merge::{MAX_BATCH_SLICES, Merge, is_merged};
use super::super::{
    BATCH_SLICES, Inputs, Order, PatchBindings, PatchRoom, PatchSlicer, Patches, accumulation,
};
use super::slices::{batch_image, batches, blend_format, clear_of};
use super::{Bound, BrickPass, Canvas, CanvasDesc, Gather, GatherDesc, PICTURE, Part, Player};
use crate::gpu::{Bindings, Error, Gpu, Load, Resource, Tile, Use};
use std::ops::Range;
use std::sync::Arc;

/// What halves are blended in.
const BATCH: usize = 1;

// The same batches as of whole slices, and so the same picture.
const _: () = assert!(BATCH_SLICES == MAX_BATCH_SLICES);

/// Slices from back to front, of which nothing is asked between them, that are drawn at once.
const UNORDERED_SLICES: u32 = 4 * BATCH_SLICES;

/// The passes of a slicer whose canvas has lists of patches.
pub(super) fn patches(desc: &GatherDesc) -> Result<Box<dyn Gather>, Error> {
    let (gpu, drawn, settings) = (desc.gpu, desc.drawn, desc.settings);
    let (technique, order) = (settings.technique, settings.order);
    let format = blend_format(gpu, drawn);
    let slicer = PatchSlicer::new(gpu, technique, drawn, order, desc.variant, format)?;
    let merge = || Merge::new(gpu, drawn, order).map(Arc::new);
    Ok(Box::new(PatchedSlices {
        gpu: Arc::clone(gpu),
        drawn,
        slicer: Arc::new(slicer),
        merge: is_merged(gpu, drawn).then(merge).transpose()?,
    }))
}

#[derive(Debug)]
struct PatchedSlices {
    gpu: Arc<Gpu>,
    drawn: Drawn,
    slicer: Arc<PatchSlicer>,
    merge: Option<Arc<Merge>>,
}

impl Gather for PatchedSlices {
    fn canvas(&self, desc: &CanvasDesc) -> Result<Canvas, Error> {
        let picture = accumulation(&self.gpu, desc.extent, "slices")?;
        let batch = self.merge.as_ref();
        let batch = batch.map(|_| batch_image(&self.gpu, desc.extent));
        let images = [Some(picture), batch.transpose()?];
        Ok(Canvas::new(desc.extent, images.into_iter().flatten()))
    }

    fn bind(
        &self,
        canvas: &Canvas,
        bricks: &[Inputs],
        _: Option<Resource>,
    ) -> Result<Box<dyn Bound>, Error> {
        let (patches, room) = canvas.patches.as_ref().expect("prepared before");
        let target = if self.merge.is_some() { BATCH } else { PICTURE };
        let blended = canvas.image(target);
        let bind = |inputs| self.slicer.bind(inputs, patches, Some(blended));
        let merge = self.merge.as_ref().map(|merge| {
            let bound = merge.bind(blended, canvas.image(PICTURE))?;
            Ok::<_, Error>((Arc::clone(merge), bound))
        });
        Ok(Box::new(BoundPatches {
            drawn: self.drawn,
            slicer: Arc::clone(&self.slicer),
            bricks: bricks.iter().map(bind).collect::<Result<_, _>>()?,
            merge: merge.transpose()?,
            patches: Arc::clone(patches),
            room: *room,
            target,
        }))
    }
}

#[derive(Debug)]
struct BoundPatches {
    drawn: Drawn,
    slicer: Arc<PatchSlicer>,
    bricks: Vec<PatchBindings>,
    merge: Option<(Arc<Merge>, Bindings)>,
    patches: Arc<Patches>,
    room: PatchRoom,
    /// What slices are blended in.
    target: usize,
}

impl Bound for BoundPatches {
    fn steps(&self, _: &Canvas, bricks: &[BrickPass], _: u32) -> Option<u64> {
        Some((self.all_steps(bricks).count() as u64).max(1))
    }

    unsafe fn record(
        &self,
        player: &mut Player,
        bricks: &[BrickPass],
        part: &Part,
    ) -> Result<(), Error> {
        let is_picture = self.drawn != Drawn::Count;
        let count = (part.steps.end - part.steps.start) as usize;
        let steps = (0..).zip(self.all_steps(bricks));
        // SAFETY: the caller's promises.
        unsafe {
            if part.is_first {
                self.start(player, bricks, is_picture);
            }
            for (number, step) in steps.skip(part.steps.start as usize).take(count) {
                let (brick, slices) = step;
                if slices.start == 0 {
                    let (bound, squares) = (&self.bricks[brick.number], self.room.squares);
                    let (offset, patches) = (brick.offset, &self.patches);
                    self.slicer.record_lists(
                        player.cmd,
                        bound,
                        offset,
                        patches,
                        squares,
                        brick.slices,
                    )?;
                }
                match &self.merge {
                    Some(merge) => self.draw_merged(player, (brick, slices), merge)?,
                    None => self.draw_onto(player, number, (brick, slices), is_picture)?,
                }
            }
            if part.is_last {
                player.bring([(PICTURE, Use::FragmentSampled)]);
            }
        }
        Ok(())
    }
}

/// Some slices of a brick that are drawn at once.
type Step<'a> = (&'a BrickPass, Range<u32>);

impl BoundPatches {
    fn all_steps<'a>(&self, bricks: &'a [BrickPass]) -> impl Iterator<Item = Step<'a>> {
        let is_merged = self.merge.is_some();
        bricks.iter().flat_map(move |brick| {
            let at_once = match is_merged || brick.order == Order::FrontToBack {
                true => BATCH_SLICES,
                false => UNORDERED_SLICES,
            };
            batches(brick.slices, at_once).map(move |slices| (brick, slices))
        })
    }

    /// # Safety
    /// As [`Bound::record`].
    unsafe fn start(&self, player: &mut Player, bricks: &[BrickPass], is_picture: bool) {
        // SAFETY: the caller's promises.
        unsafe {
            // What has been opaque in the picture is not counted either.
            if is_picture || self.merge.is_some() {
                self.patches.record_start(player.cmd);
            }
            if self.merge.is_some() {
                player.clear(PICTURE);
            } else if self.all_steps(bricks).next().is_none() {
                player.bring([(PICTURE, Use::ColorTarget)]);
                let whole = Tile::whole(player.canvas.extent());
                player.render((PICTURE, self.cleared()), None, whole, |_| ());
            }
        }
    }

    fn cleared(&self) -> Load {
        Load::Clear(clear_of(self.drawn))
    }

    /// Onto the slices before it.
    ///
    /// # Safety
    /// As [`Bound::record`].
    unsafe fn draw_onto(
        &self,
        player: &mut Player,
        number: u32,
        step: Step,
        is_picture: bool,
    ) -> Result<(), Error> {
        let (cmd, patches, (brick, _)) = (player.cmd, &self.patches, &step);
        let is_ordered = brick.order == Order::FrontToBack;
        // SAFETY: the caller's promises.
        unsafe {
            match (is_ordered, is_picture) {
                (true, true) if number > 0 => {
                    player.bring([(PICTURE, Use::ComputeSampled)]);
                    let (bound, squares) = (&self.bricks[brick.number], self.room.squares);
                    let offset = brick.offset;
                    self.slicer
                        .record_opaque(cmd, bound, offset, patches, squares, number + 1)?;
                }
                (true, false) => patches.record_batch(cmd, number + 1),
                _ => {}
            }
            player.bring([(PICTURE, Use::ColorTarget)]);
            let load = if number == 0 {
                self.cleared()
            } else {
                Load::Keep
            };
            self.draw(player, step, load);
        }
        Ok(())
    }

    /// Into an image of its own, and from there into the picture.
    ///
    /// # Safety
    /// As [`Bound::record`].
    unsafe fn draw_merged(
        &self,
        player: &mut Player,
        step: Step,
        (merge, bound): &(Arc<Merge>, Bindings),
    ) -> Result<(), Error> {
        // SAFETY: the caller's promises.
        unsafe {
            player.bring([(BATCH, Use::ColorTarget)]);
            self.draw(player, step, Load::Clear([0.0; 4]));
            player.bring([(BATCH, Use::ComputeSampled), (PICTURE, Use::ComputeWrite)]);
            merge.record(player.cmd, bound, player.canvas.extent())
        }
    }

    /// # Safety
    /// As [`Bound::record`]; the target is in [`Use::ColorTarget`].
    unsafe fn draw(&self, player: &Player, (brick, slices): Step, load: Load) {
        let extent = player.canvas.extent();
        let (bound, whole) = (&self.bricks[brick.number], Tile::whole(extent));
        // SAFETY: the caller's promises.
        unsafe {
            player.render((self.target, load), None, whole, |cmd| {
                let (offset, patches) = (brick.offset, &self.patches);
                self.slicer
                    .record(cmd, bound, offset, extent, patches, slices);
            });
        }
    }
}
