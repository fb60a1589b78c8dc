//! Level C in parts: frames, uploads and updates in submissions that are short, and that a host may end.
//!
//! ```text
//! for each part    record, submit, wait; tell the host, which may end it; the last is not waited for
//! ```

use super::pieces::PIECE_MS;
use super::{Error, FrameInfo, QueueLock, Renderer, Submitter, Update, Volume};
use crate::gpu::{Gpu, Load, Pace, Target, TimelinePoint};
use ash::vk;
use std::fmt;
use std::ops::ControlFlow;
use std::time::Instant;

/// How long the parts of a frame, an upload or an update last, and who hears of them ([`Submitter::submit_in_parts`]).
pub struct Pacing<'a> {
    /// Milliseconds that a submission shall take: [`Pacing::TARGET_MS`] are far below the seconds after which systems
    /// take a device for hung.
    pub target_ms: f64,
    /// Told after each part but the last how much is done, 0 to 1. [`ControlFlow::Break`] ends it.
    pub tell: &'a mut dyn FnMut(f64) -> ControlFlow<()>,
}

impl Pacing<'_> {
    /// What is asked for where nothing speaks against it.
    pub const TARGET_MS: f64 = crate::gpu::TARGET_MS;
}

impl fmt::Debug for Pacing<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut debug = f.debug_struct("Pacing");
        debug
            .field("target_ms", &self.target_ms)
            .finish_non_exhaustive()
    }
}

/// Where, after what, and what is reached then.
#[derive(Clone, Copy)]
struct To<'a> {
    lock: QueueLock<'a>,
    frame: u32,
    waits: &'a [TimelinePoint],
    signals: &'a [TimelinePoint],
}

impl Submitter {
    /// [`Submitter::submit`] in as many submissions as it takes for each to last no longer than `pacing` says: the
    /// first begins when all of `waits` are reached, the last reaches all of `signals`. Between them the CPU waits for
    /// the device, and `pacing` is told how far the frame is and may end it. What is drawn is to the bit what
    /// [`Submitter::submit`] draws.
    ///
    /// True: the last part is submitted. False: the frame was ended before; no signal will be reached, the renderer is
    /// free for another frame, and the target is as [`Renderer::record_part_into`] says.
    ///
    /// # Errors
    /// As [`Submitter::submit`]; then, too, no signal will be reached.
    ///
    /// # Safety
    /// As [`Submitter::submit`]; `waits` are reached without the calling thread.
    #[allow(
        clippy::too_many_arguments,
        reason = "what a frame is, when, and in which parts"
    )]
    pub unsafe fn submit_in_parts(
        &mut self,
        renderer: &mut Renderer,
        shot: &FrameInfo,
        target: &Target,
        load: Load,
        lock: QueueLock,
        waits: &[TimelinePoint],
        signals: &[TimelinePoint],
        pacing: Pacing,
    ) -> Result<bool, Error> {
        let frame = shot.frame;
        renderer.check_target(target, load)?;
        renderer.begin_parts(shot)?;
        let work = renderer.left_of(frame)?;
        let mut before = renderer.function.uploaded();
        let to = To {
            lock,
            frame,
            waits,
            signals,
        };
        // SAFETY: the caller's promises; each part is done before the next one is recorded.
        let ended = unsafe {
            self.run_in_parts(to, &work, pacing, &mut |cmd, count| {
                before = renderer.function.uploaded();
                renderer.record_part_into(cmd, frame, count, target, load)?;
                Ok(())
            })
        };
        if ended.is_err() {
            renderer.function.forget_later(before);
            renderer.restart_paths();
        }
        renderer.end_parts(frame);
        ended
    }

    /// [`Volume::record_upload`] in submissions as [`Submitter::submit_in_parts`] makes them, with number `frame` of
    /// the frames in flight.
    ///
    /// True: all of it is submitted. False: it was ended before; the volume is not drawn until the rest is recorded, in
    /// parts or at once.
    ///
    /// # Errors
    /// As [`Volume::record_upload`], and as [`Submitter::submit`]; what was not submitted may be recorded again.
    ///
    /// # Safety
    /// As [`Submitter::submit_in_parts`], and [`Volume::record_upload`].
    #[allow(
        clippy::too_many_arguments,
        reason = "what is brought there, when, and in which parts"
    )]
    pub unsafe fn upload_in_parts(
        &mut self,
        gpu: &Gpu,
        volume: &mut Volume,
        frame: u32,
        lock: QueueLock,
        waits: &[TimelinePoint],
        signals: &[TimelinePoint],
        pacing: Pacing,
    ) -> Result<bool, Error> {
        let left = volume.upload_parts()?;
        if left == 0 {
            return Err(Error::Uploaded);
        }
        let mut before = volume.recorded_pieces();
        let to = To {
            lock,
            frame,
            waits,
            signals,
        };
        // SAFETY: the caller's promises, and as above.
        let ended = unsafe {
            self.run_in_parts(
                to,
                &[(left, PIECE_MS * left as f64)],
                pacing,
                &mut |cmd, count| {
                    before = volume.recorded_pieces();
                    volume.record_pieces(gpu, cmd, count).map(drop)
                },
            )
        };
        match ended {
            Ok(true) => volume.end_upload(),
            Ok(false) => {}
            Err(_) => volume.forget_pieces(before),
        }
        ended
    }

    /// [`Volume::record_update`] in submissions as [`Submitter::submit_in_parts`] makes them, with number `frame` of
    /// the frames in flight.
    ///
    /// True: all of it is submitted. False: it was ended before; the volume is not drawn until the rest of the update
    /// is recorded, or another that changes all of its voxels.
    ///
    /// # Errors
    /// As [`Volume::record_update`], and as [`Submitter::submit`]; what was not submitted may be recorded again.
    ///
    /// # Safety
    /// As [`Submitter::submit_in_parts`], and [`Volume::record_update`].
    #[allow(
        clippy::too_many_arguments,
        reason = "what is brought there, when, and in which parts"
    )]
    pub unsafe fn update_in_parts(
        &mut self,
        volume: &Volume,
        update: &mut Update,
        frame: u32,
        lock: QueueLock,
        waits: &[TimelinePoint],
        signals: &[TimelinePoint],
        pacing: Pacing,
    ) -> Result<bool, Error> {
        volume.check_update(update)?;
        let (left, first) = (update.parts(), update.recorded_pieces());
        let mut before = first;
        let to = To {
            lock,
            frame,
            waits,
            signals,
        };
        // SAFETY: the caller's promises, and as above.
        let ended = unsafe {
            self.run_in_parts(
                to,
                &[(left, PIECE_MS * left as f64)],
                pacing,
                &mut |cmd, count| {
                    before = update.recorded_pieces();
                    volume.record_update_pieces(cmd, update, count)
                },
            )
        };
        if ended.is_err() {
            update.forget_pieces(before);
        }
        if update.recorded_pieces() > first {
            update.settle();
        }
        ended
    }

    /// Submits `work`, kinds of pieces with what each kind is thought to take, in parts.
    ///
    /// # Safety
    /// As [`Submitter::submit_in_parts`], of what `record` records of so many of the next pieces.
    unsafe fn run_in_parts(
        &mut self,
        to: To,
        work: &[(u64, f64)],
        pacing: Pacing,
        record: &mut dyn FnMut(vk::CommandBuffer, u64) -> Result<(), Error>,
    ) -> Result<bool, Error> {
        let all: u64 = work.iter().map(|(units, _)| units).sum();
        if !to.waits.is_empty() {
            // By itself: how long the host takes is no part of how long pieces take.
            // SAFETY: the caller's promises.
            unsafe { self.run_and_wait(to, |_| Ok(()))? };
        }
        let to = To { waits: &[], ..to };
        let mut done = 0;
        for &(units, expected_ms) in work {
            let mut pace = Pace::new(units, expected_ms, pacing.target_ms);
            while let Some(part) = pace.next() {
                let count = part.end - part.start;
                done += count;
                if done == all {
                    // SAFETY: the caller's promises.
                    unsafe {
                        self.run(to.lock, to.frame, &[], to.signals, |cmd| record(cmd, count))?;
                    }
                    return Ok(true);
                }
                let begun = Instant::now();
                // SAFETY: as above.
                unsafe { self.run_and_wait(to, |cmd| record(cmd, count))? };
                pace.took(part, 1e3 * begun.elapsed().as_secs_f64());
                if (pacing.tell)(done as f64 / all as f64).is_break() {
                    return Ok(false);
                }
            }
        }
        Ok(true)
    }

    /// # Safety
    /// As [`Submitter::run`].
    unsafe fn run_and_wait(
        &mut self,
        to: To,
        record: impl FnOnce(vk::CommandBuffer) -> Result<(), Error>,
    ) -> Result<(), Error> {
        // SAFETY: the caller's promises.
        unsafe { self.run_fenced(to.lock, to.frame, to.waits, &[], true, record)? };
        Ok(self.commands.wait()?)
    }
}
