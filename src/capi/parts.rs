//! Frames, uploads and updates in parts, each a submission, that a host may end.

use super::handles::{self, Kind};
use super::images::{sv_target, target};
use super::record::{Taken, sv_frame_info};
use super::renderer::{self, sv_renderer, with};
use super::status::{Failure, guard, number, sv_diagnostic, sv_status};
use super::structure::{self, Versioned};
use super::submit::{self, Submission, sv_submission, sv_submitter};
use super::update::{self, sv_update};
use super::volume::{self, commands, sv_volume};
use crate::embed::{Pacing, QueueLock};
use crate::gpu::TimelinePoint;
use std::ffi::c_void;
use std::ops::ControlFlow;

/// How long the submissions of a frame, an upload or an update last, and who hears of them.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_pacing {
    /// `sizeof(sv_pacing)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// Milliseconds that a submission shall take. 0 is 100.
    pub target_ms: f64,
    /// Called after each submission but the last with how much is done, 0 to 1; not 0 ends it. Or NULL.
    /// It calls no function of this header.
    pub tell: Option<unsafe extern "C" fn(user: *mut c_void, done: f64) -> u32>,
    /// What `tell` is called with.
    pub user: *mut c_void,
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_pacing {
    const NAME: &'static str = "sv_pacing";
}

/// Begins a frame that is recorded in parts, and tells how many pieces it has: blocks of 64 x 64 pixels, smaller where
/// those are thought to take long, slices of half-angle slicing, and what a new function has to be found empty. What
/// else is recorded for the frame, another function, volume or size, and an update of the volume, ends it. Threads: one
/// at a time for one renderer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_renderer_begin_parts(
    renderer: sv_renderer,
    shot: *const sv_frame_info,
    pieces: *mut u64,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the number of pieces", pieces)?;
        with(renderer, |_, inner| {
            // SAFETY: the caller's promise.
            unsafe {
                let taken = Taken::new(shot, inner)?;
                pieces.write(inner.renderer.begin_parts(&taken.shot())?);
            }
            Ok(())
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Level B in parts: records the next `count` pieces, one at least, and tells how many are left. The same `target` each
/// time.
///
/// Rays, and slices in other modes than composite, touch the target with the last part alone. Composites by slices draw
/// each part into it, and leave it in its state `after`. As sv_renderer_record_into; parts are submitted in their order
/// to one queue.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_renderer_record_part_into(
    renderer: sv_renderer,
    command_buffer: *mut c_void,
    frame: u32,
    count: u64,
    target: *const sv_target,
    left: *mut u64,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the number of pieces", left)?;
        with(renderer, |_, inner| {
            let cmd = commands(command_buffer)?;
            // SAFETY: the caller's promise.
            unsafe {
                let (target, load) = self::target(target)?;
                let renderer = &mut inner.renderer;
                left.write(renderer.record_part_into(cmd, frame, count, &target, load)?);
            }
            Ok(())
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Level C in parts: as sv_submitter_submit, in as many submissions as it takes for each to last no longer than
/// `pacing` says (NULL: 100 ms). Between them it waits for the device, for the host's `waits` too. `is_done` is set to
/// 0 where the host ended the frame: none of the signals will be reached then, and the target is as
/// sv_renderer_record_part_into says. Threads: one at a time for one submitter and for one renderer.
#[unsafe(no_mangle)]
#[allow(
    clippy::too_many_arguments,
    reason = "those of sv_submitter_submit, and two"
)]
pub unsafe extern "C" fn sv_submitter_submit_in_parts(
    submitter: sv_submitter,
    renderer: sv_renderer,
    shot: *const sv_frame_info,
    target: *const sv_target,
    submission: *const sv_submission,
    pacing: *const sv_pacing,
    is_done: *mut u32,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of is_done", is_done)?;
        let (device, held) = handles::find::<submit::Held>(submitter)?;
        handles::find_on::<renderer::Held>(&device, renderer)?;
        let mut submitter = handles::only(submit::Held::NAME, &held.0)?;
        with(renderer, |_, inner| {
            // SAFETY: the caller's promise.
            unsafe {
                let taken = Taken::new(shot, inner)?;
                let (target, load) = self::target(target)?;
                let (shot, renderer) = (taken.shot(), &mut inner.renderer);
                in_parts(
                    submission,
                    pacing,
                    is_done,
                    |lock, waits, signals, pacing| {
                        Ok(submitter.submit_in_parts(
                            renderer, &shot, &target, load, lock, waits, signals, pacing,
                        )?)
                    },
                )
            }
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// sv_submitter_upload in as many submissions as it takes for each to last no longer than `pacing` says (NULL: 100 ms).
/// Between them it waits for the device, for the host's `waits` too. `is_done` is set to 0 where the host ended it:
/// none of the signals will be reached then, and the rest of the upload is still to be recorded. As
/// sv_submitter_submit_in_parts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_submitter_upload_in_parts(
    submitter: sv_submitter,
    volume: sv_volume,
    frame: u32,
    submission: *const sv_submission,
    pacing: *const sv_pacing,
    is_done: *mut u32,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of is_done", is_done)?;
        let (device, held) = handles::find::<submit::Held>(submitter)?;
        let volume = handles::find_on::<volume::Held>(&device, volume)?;
        let mut submitter = handles::only(submit::Held::NAME, &held.0)?;
        // SAFETY: the caller's promise.
        device.run(|| unsafe {
            in_parts(
                submission,
                pacing,
                is_done,
                |lock, waits, signals, pacing| {
                    volume.upload(|volume| {
                        let gpu = &device.gpu;
                        submitter.upload_in_parts(gpu, volume, frame, lock, waits, signals, pacing)
                    })
                },
            )
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// sv_volume_record_update in submissions of the library's own, in parts. `is_done` is set to 0 where the host ended
/// it: none of the signals will be reached then, and the rest of the update is still to be recorded. As
/// sv_submitter_upload_in_parts.
#[unsafe(no_mangle)]
#[allow(
    clippy::too_many_arguments,
    reason = "those of sv_submitter_upload_in_parts, and one"
)]
pub unsafe extern "C" fn sv_submitter_update_in_parts(
    submitter: sv_submitter,
    volume: sv_volume,
    update: sv_update,
    frame: u32,
    submission: *const sv_submission,
    pacing: *const sv_pacing,
    is_done: *mut u32,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of is_done", is_done)?;
        let (device, held) = handles::find::<submit::Held>(submitter)?;
        let volume = handles::find_on::<volume::Held>(&device, volume)?;
        let mut submitter = handles::only(submit::Held::NAME, &held.0)?;
        // SAFETY: the caller's promise.
        device.run(|| unsafe {
            in_parts(
                submission,
                pacing,
                is_done,
                |lock, waits, signals, pacing| {
                    update::with(&device, update, &volume, |volume, staged| {
                        Ok(submitter
                            .update_in_parts(volume, staged, frame, lock, waits, signals, pacing)?)
                    })
                },
            )
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Does `work` as `submission` and `pacing` say, and tells in `is_done` whether all of it is submitted.
///
/// # Safety
/// As [`Submission::new`] and [`paced`]; `is_done` is the caller's to write.
unsafe fn in_parts(
    submission: *const sv_submission,
    pacing: *const sv_pacing,
    is_done: *mut u32,
    work: impl FnOnce(QueueLock, &[TimelinePoint], &[TimelinePoint], Pacing) -> Result<bool, Failure>,
) -> Result<(), Failure> {
    // SAFETY: the caller's promise, here and below.
    let (submission, asked) = unsafe { (Submission::new(submission)?, paced(pacing)?) };
    let locked = submission.locked();
    let lock = submission.lock(&locked);
    // SAFETY: as above.
    let mut tell = |done: f64| unsafe { told(&asked, done) };
    let pacing = Pacing {
        target_ms: asked.target_ms,
        tell: &mut tell,
    };
    let done = work(lock, &submission.waits, &submission.signals, pacing)?;
    // SAFETY: as above.
    unsafe { is_done.write(done.into()) };
    Ok(())
}

/// What a caller says of it, with the time that is asked for where none is told.
///
/// # Safety
/// As [`structure::read_or_zero`].
unsafe fn paced(pointer: *const sv_pacing) -> Result<sv_pacing, Failure> {
    // SAFETY: the caller's promise.
    let mut pacing = unsafe { structure::read_or_zero(pointer)? };
    let ms = pacing.target_ms;
    let name = "sv_pacing.target_ms";
    number(name, "0 or more", ms, ms.is_finite() && ms >= 0.0)?;
    if ms == 0.0 {
        pacing.target_ms = Pacing::TARGET_MS;
    }
    Ok(pacing)
}

/// Asks the host.
///
/// # Safety
/// `tell` is a function of the host's that takes `user`.
unsafe fn told(pacing: &sv_pacing, done: f64) -> ControlFlow<()> {
    match pacing.tell {
        // SAFETY: the caller's promise.
        Some(tell) if unsafe { tell(pacing.user, done) } != 0 => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    }
}
