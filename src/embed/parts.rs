//! A frame in parts, on devices that take long for one: each part is a submission of its own, and a host may stop
//! between two of them.
//!
//! ```text
//! renderer.begin_parts(shot)                            parameters; how many pieces there are: mostly blocks of the picture
//! renderer.record_part_into(cmd, frame, n, target, ..)  the next n of them, until none is left
//! submitter.submit_in_parts(..)                         both, as many blocks a submission as take 100 ms
//! ```
//!
//! All parts together draw the very picture that one recording would.

use super::frame::{Begun, Cut};
use super::pieces::PIECE_MS;
use super::{Error, FrameInfo, Renderer};
use crate::gpu::{Blocks, Load, Target, Tile, Use, begin_rendering, end_rendering};
use crate::technique::cost::{fetches_of_costliest_pixel, fetches_of_picture, ms_of_fetches};
use crate::technique::gather::Part;
use ash::vk;

/// Pixels along the side of a block, and of one that is thought to take long.
const SIDE: u32 = 64;
const SMALLEST_SIDE: u32 = Tile::STEP;

impl Renderer {
    /// Begins a frame in parts: writes its parameters. How many pieces there are: blocks of 64 x 64 pixels, or of 32,
    /// 16 or 8 where larger ones are thought to take long, any first part of them spread over the picture; of
    /// half-angle slices each slice, or bands of it; and before them what a new function, or an update of the volume,
    /// has to be found empty.
    ///
    /// What else is recorded for the frame, another function, volume or size, and an update of the volume, ends it. As
    /// before [`Renderer::record`], what was recorded for the frame before is done: its parameters are written over,
    /// and what is not done draws with those.
    ///
    /// # Errors
    /// As [`Renderer::record`]; [`Error::NotEmbedded`] for slices that are blended in the target.
    pub fn begin_parts(&mut self, shot: &FrameInfo) -> Result<u64, Error> {
        if self.pass.resolve.is_none() {
            return Err(Error::NotEmbedded {
                what: "a composite by slices in parts that are blended in the target",
                hint: "take `SliceBlending::Float`, or `record_into`",
            });
        }
        let (frame, recorded) = self.prepare(shot)?;
        let slices = recorded.picture.iter().map(|part| part.slices).sum();
        let view = self.view(shot);
        let ms = |fetches| ms_of_fetches(&self.gpu, fetches);
        let expected_ms = ms(fetches_of_picture(&view, slices, 1));
        // A slice is drawn twice, and both are counted.
        let a_step = expected_ms / f64::from(slices.max(1));
        let bands = (a_step / PIECE_MS).ceil().max(1.0) as u32;
        let cut = match self.steps(frame, &recorded, bands) {
            Some(count) => Cut::Steps { count, bands },
            None => {
                let side = side_of_block(ms(fetches_of_costliest_pixel(&view, slices)));
                let count = self.extent.map(|n| n.div_ceil(side));
                Cut::Blocks(Blocks::new(self.extent, count))
            }
        };
        let count = cut.count() + self.function.left(&self.volume)?;
        self.frames[frame].begun = Some(Begun {
            recorded,
            cut,
            next: 0,
            after: self.volume.updates.done(),
            expected_ms,
        });
        Ok(count)
    }

    /// Level B, in parts: records the next `count` pieces, one at least, and says how many are left.
    ///
    /// The last part alone touches the target: a frame that is given up before has left it as it was, in its state
    /// `before`.
    ///
    /// # Errors
    /// [`Error::NotBegun`]; as [`Renderer::record_into`]. Where the device fails, the frame is at an end.
    ///
    /// # Safety
    /// - As [`Renderer::record_into`], of all parts of a frame: they are submitted in their order, to one queue, and
    ///   with nothing else between them that uses the target;
    /// - the target is in the state that was said above.
    pub unsafe fn record_part_into(
        &mut self,
        cmd: vk::CommandBuffer,
        frame: u32,
        count: u64,
        target: &Target,
        load: Load,
    ) -> Result<u64, Error> {
        self.gpu.check_alive("record a part of a frame")?;
        let number = self.frame_number(frame)?;
        self.check_target(target, load)?;
        self.volume.updates.check_whole()?;
        let begun = self.frames[number].begun.take();
        let is_current = |begun: &Begun| begun.after == self.volume.updates.done();
        let begun = begun.filter(is_current);
        let mut begun = begun.ok_or(Error::NotBegun { frame })?;
        let all = begun.cut.count();
        let before = self.function.left(&self.volume)?.min(count.max(1));
        if before > 0 {
            // SAFETY: the caller's promises.
            unsafe { self.function.record_part(cmd, &self.volume, before)? };
        }
        let count = count.max(1) - before;
        if count == 0 {
            let left = all - begun.next + self.function.left(&self.volume)?;
            self.frames[number].begun = Some(begun);
            return Ok(left);
        }
        let range = begun.next..begun.next.saturating_add(count).min(all);
        let (tiles, bands) = match &begun.cut {
            Cut::Blocks(blocks) => (blocks.tiles(range.clone()), 1),
            Cut::Steps { bands, .. } => (Vec::new(), *bands),
        };
        let part = Part {
            tiles: &tiles,
            is_first: range.start == 0,
            is_last: range.end == all,
            steps: range,
            bands,
        };
        let recorded = &begun.recorded;
        // SAFETY: the caller's promises.
        unsafe {
            self.gather(cmd, number, recorded, &part)?;
            if part.is_last {
                target.enter(&self.gpu, cmd, Use::ColorTarget);
                begin_rendering(&self.gpu, cmd, &[(target.view, load)], self.extent);
                self.draw_picture(cmd, &self.frames[number], recorded);
                end_rendering(&self.gpu, cmd);
                target.leave(&self.gpu, cmd, Use::ColorTarget);
            }
        }
        match part.is_last {
            true => self.keep(number, begun.recorded),
            false => {
                begun.next = part.steps.end;
                self.frames[number].begun = Some(begun);
            }
        }
        Ok(all - part.steps.end)
    }

    /// Gives a frame in parts up.
    pub(super) fn end_parts(&mut self, frame: u32) {
        if let Some(there) = self.frames.get_mut(frame as usize) {
            there.begun = None;
        }
    }

    /// What is left of a frame in parts: pieces of the function, then those of the picture with what they are thought
    /// to take.
    pub(super) fn left_of(&self, frame: u32) -> Result<[(u64, f64); 2], Error> {
        let function = self.function.left(&self.volume)?;
        let begun = self.frames.get(frame as usize);
        let begun = begun.and_then(|frame| frame.begun.as_ref());
        let picture = begun.map_or((0, 0.0), |begun| {
            (begun.cut.count() - begun.next, begun.expected_ms)
        });
        Ok([(function, PIECE_MS * function as f64), picture])
    }
}

/// The largest side of which a block is not thought to take long, wherever it lies.
fn side_of_block(pixel_ms: f64) -> u32 {
    let is_long = |side: u32| f64::from(side).powi(2) * pixel_ms > PIECE_MS;
    let mut side = SIDE;
    while side > SMALLEST_SIDE && is_long(side) {
        side /= 2;
    }
    side
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_takes_no_longer_than_a_piece_but_where_it_is_the_smallest() {
        for pixel_ms in [0.0, 1e-6, 0.004, 0.005, 0.02, 0.3, 0.4, 5.0] {
            let side = side_of_block(pixel_ms);
            let ms = |side: u32| f64::from(side).powi(2) * pixel_ms;
            assert!(side == SMALLEST_SIDE || ms(side) <= PIECE_MS, "{pixel_ms}");
            assert!(side == SIDE || ms(2 * side) > PIECE_MS, "{pixel_ms}");
        }
    }
}
