//! Level C: frames that we submit.

use super::renderer_desc::check_frames;
use super::{Error, FrameInfo, Renderer, Volume};
use crate::gpu::{Commands, Gpu, Load, Target, TimelinePoint};
use ash::vk;
use std::fmt;
use std::sync::Arc;

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

/// Command buffers for frames that we submit.
#[derive(Debug)]
pub struct Submitter {
    pub(super) commands: Commands,
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
        shot: &FrameInfo,
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
            renderer.restart_paths();
        }
        submitted
    }

    /// [`Volume::record_upload`] in a submission of our own, with number `frame` of the frames in flight.
    ///
    /// # Errors
    /// As [`Volume::record_upload`], and as [`Submitter::submit`]; the upload may be recorded again then.
    ///
    /// # Safety
    /// As [`Submitter::submit`], and [`Volume::record_upload`].
    pub unsafe fn upload(
        &mut self,
        gpu: &Gpu,
        volume: &mut Volume,
        frame: u32,
        lock: QueueLock,
        waits: &[TimelinePoint],
        signals: &[TimelinePoint],
    ) -> Result<(), Error> {
        let recorded = volume.recorded_pieces();
        // SAFETY: the caller's promises.
        let submitted = unsafe {
            self.run(lock, frame, waits, signals, |cmd| {
                volume.record_pieces(gpu, cmd, u64::MAX).map(drop)
            })
        };
        match submitted {
            Ok(()) => volume.end_upload(),
            Err(_) => volume.forget_pieces(recorded),
        }
        submitted
    }

    /// Whatever `record` records, submitted in the same way: picks, and the host's own.
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
    pub(super) unsafe fn run_fenced(
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
