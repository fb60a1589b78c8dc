//! Level C: frames that we submit.

use super::class::check_frames;
use super::{Error, Renderer, Shot};
use crate::gpu::{Commands, Gpu, Load, Pace, Target, TimelinePoint};
use ash::vk;
use std::fmt;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

/// A host's queue, and the lock around it: another thread of the host's may submit to it too.
#[derive(Clone, Copy)]
pub struct QueueLock<'a> {
    /// The queue, of [`Gpu::queue_family`].
    pub queue: vk::Queue,
    /// Calls what it is given, once, while nobody else uses the queue.
    pub locked: &'a dyn Fn(&mut dyn FnMut()),
}

impl fmt::Debug for QueueLock<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut debug = f.debug_struct("QueueLock");
        debug.field("queue", &self.queue).finish_non_exhaustive()
    }
}

/// How long the parts of a frame last, and who hears of them ([`Submitter::submit_in_parts`]).
pub struct Pacing<'a> {
    /// Milliseconds that a submission shall take: [`Pacing::TARGET_MS`] are far below the seconds after which systems take a
    /// device for hung.
    pub target_ms: f64,
    /// Told after each part but the last how much of the frame is done, 0 to 1. [`ControlFlow::Break`] ends the frame.
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

/// Command buffers for frames that we submit.
#[derive(Debug)]
pub struct Submitter {
    commands: Commands,
}

impl Submitter {
    /// For so many frames in flight.
    ///
    /// # Errors
    /// [`Error::FramesInFlight`]; where `timelineSemaphore` is not enabled on the device; no memory.
    pub fn new(gpu: &Arc<Gpu>, frames_in_flight: u32) -> Result<Self, Error> {
        check_frames(frames_in_flight)?;
        let commands = Commands::new(gpu, frames_in_flight)?;
        Ok(Self { commands })
    }

    /// [`Renderer::record_into`] in a submission of our own, that begins when all of `waits` are reached and reaches
    /// all of `signals`. Nothing waits on the CPU but for the lock.
    ///
    /// # Errors
    /// As [`Renderer::record_into`]: nothing is submitted then. A device that is lost.
    ///
    /// # Safety
    /// As [`Renderer::record_into`]; nothing unfinished was submitted by this submitter with the shot's number, of
    /// whatever renderer; semaphores are timelines of the device and live until the submission is done, and
    /// while `lock` calls back nobody else uses the queue.
    #[allow(clippy::too_many_arguments, reason = "what a frame is, and when")]
    pub unsafe fn submit(
        &mut self,
        renderer: &mut Renderer,
        shot: &Shot,
        target: &Target,
        load: Load,
        lock: QueueLock,
        waits: &[TimelinePoint],
        signals: &[TimelinePoint],
    ) -> Result<(), Error> {
        let uploaded = renderer.function.uploaded();
        // SAFETY: the caller's promises.
        let submitted = unsafe {
            self.run(lock, shot.frame, waits, signals, |cmd| {
                renderer.record_into(cmd, shot, target, load)
            })
        };
        if submitted.is_err() {
            renderer.function.forget_later(uploaded);
        }
        submitted
    }

    /// The same in as many submissions as it takes for each to last no longer than `pacing` says: the first begins when all
    /// of `waits` are reached, the last reaches all of `signals`. Between them the CPU waits for the device, and `pacing`
    /// is told how far the frame is and may end it. What is drawn is to the bit what [`Submitter::submit`] draws.
    ///
    /// True: the last part is submitted. False: the frame was ended before; no signal will be reached, the renderer is free for
    /// another frame, and the target is as [`Renderer::record_part_into`] says.
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
        shot: &Shot,
        target: &Target,
        load: Load,
        lock: QueueLock,
        waits: &[TimelinePoint],
        signals: &[TimelinePoint],
        pacing: Pacing,
    ) -> Result<bool, Error> {
        let frame = shot.frame;
        renderer.check_parts(target, load)?;
        let count = renderer.begin_parts(shot)?;
        let mut pace = Pace::new(count, renderer.expected_ms(shot), pacing.target_ms);
        let ended = loop {
            let Some(part) = pace.next() else {
                break Ok(true);
            };
            if part.start == 0 && !waits.is_empty() {
                // By itself: how long the host takes is no part of how long blocks take.
                // SAFETY: the caller's promises.
                let waited = unsafe { self.run_and_wait(lock, frame, waits, |_| Ok(())) };
                if let Err(error) = waited {
                    break Err(error);
                }
            }
            let uploaded = renderer.function.uploaded();
            let (is_last, blocks) = (part.end == count, part.end - part.start);
            let begun = Instant::now();
            // SAFETY: the caller's promises; each part is done before the next one is recorded.
            let run = unsafe {
                let record = |cmd| {
                    let recorded = renderer.record_part_into(cmd, frame, blocks, target, load);
                    recorded.map(drop)
                };
                match is_last {
                    true => self.run(lock, frame, &[], signals, record),
                    false => self.run_and_wait(lock, frame, &[], record),
                }
            };
            if let Err(error) = run {
                renderer.function.forget_later(uploaded);
                break Err(error);
            }
            if is_last {
                break Ok(true);
            }
            pace.took(part, 1e3 * begun.elapsed().as_secs_f64());
            if (pacing.tell)(pace.part()).is_break() {
                break Ok(false);
            }
        };
        renderer.end_parts(frame);
        ended
    }

    /// # Safety
    /// As [`Submitter::run`].
    unsafe fn run_and_wait(
        &mut self,
        lock: QueueLock,
        frame: u32,
        waits: &[TimelinePoint],
        record: impl FnOnce(vk::CommandBuffer) -> Result<(), Error>,
    ) -> Result<(), Error> {
        // SAFETY: the caller's promises.
        unsafe { self.run_fenced(lock, frame, waits, &[], true, record)? };
        Ok(self.commands.wait()?)
    }

    /// Whatever `record` records, submitted in the same way: uploads.
    ///
    /// # Errors
    /// Those of `record`: nothing is submitted then. A device that is lost.
    ///
    /// # Safety
    /// As [`Submitter::submit`].
    pub unsafe fn run(
        &mut self,
        lock: QueueLock,
        frame: u32,
        waits: &[TimelinePoint],
        signals: &[TimelinePoint],
        record: impl FnOnce(vk::CommandBuffer) -> Result<(), Error>,
    ) -> Result<(), Error> {
        // SAFETY: the caller's promises.
        unsafe { self.run_fenced(lock, frame, waits, signals, false, record) }
    }

    /// # Safety
    /// As [`Submitter::run`]; where `is_fenced`, [`Commands::wait`] comes before the next one.
    unsafe fn run_fenced(
        &mut self,
        lock: QueueLock,
        frame: u32,
        waits: &[TimelinePoint],
        signals: &[TimelinePoint],
        is_fenced: bool,
        record: impl FnOnce(vk::CommandBuffer) -> Result<(), Error>,
    ) -> Result<(), Error> {
        // SAFETY: the caller's promises.
        unsafe { self.commands.record(frame, record)? };
        let mut submitted = Err(crate::gpu::Error::Argument {
            doing: "submit a frame".into(),
            wanted: "a lock that calls what it is given".into(),
            found: "one that does not".into(),
        });
        (lock.locked)(&mut || {
            // SAFETY: as above; recorded just now.
            submitted = unsafe {
                let commands = &self.commands;
                commands.submit(lock.queue, frame, waits, signals, is_fenced)
            };
        });
        Ok(submitted?)
    }
}
