//! Level C: frames that we submit.

use super::device::sv_device;
use super::handles::{self, Kind};
use super::images::{MOST_FRAMES, sv_target, target};
use super::record::{Taken, sv_frame_info};
use super::renderer::{self, sv_renderer};
use super::status::{Failure, guard, sv_diagnostic, sv_status};
use super::structure::{self, Versioned};
use super::volume::{self, sv_volume};
use crate::embed::{QueueLock, Submitter};
use crate::gpu::TimelinePoint;
use ash::vk::{self, Handle};
use std::ffi::c_void;
use std::sync::Mutex;

/// Command buffers for frames that the library submits. 0 is none.
pub type sv_submitter = u64;

/// A timeline semaphore of the host's, and one of its values.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_timeline_point {
    /// `VkSemaphore`, of type timeline.
    pub semaphore: u64,
    /// Its value.
    pub value: u64,
}

/// When a submission begins and what it reaches.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_submission {
    /// `sizeof(sv_submission)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// `VkQueue`, of the device's family.
    pub queue: *mut c_void,
    /// Called before the queue is used, or NULL where nobody else uses it. It calls no function of this header.
    pub lock: Option<unsafe extern "C" fn(user: *mut c_void)>,
    /// Called after that; NULL where `lock` is.
    pub unlock: Option<unsafe extern "C" fn(user: *mut c_void)>,
    /// What both are called with.
    pub user: *mut c_void,
    /// It begins when all of them are reached.
    pub waits: *const sv_timeline_point,
    /// How many there are.
    pub wait_count: u64,
    /// All of them are reached when it is done.
    pub signals: *const sv_timeline_point,
    /// How many there are.
    pub signal_count: u64,
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_submission {
    const NAME: &'static str = "sv_submission";
}

/// More points than this are a mistake.
const MOST_POINTS: u64 = 256;

/// One thread at a time.
pub(super) struct Held(pub Mutex<Submitter>);

impl Kind for Held {
    const NUMBER: u64 = 5;
    const NAME: &'static str = "sv_submitter";
}

/// Command buffers for so many frames in flight, at most 64. Wants SV_FEATURE_TIMELINE_SEMAPHORE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_submitter_create(
    device: sv_device,
    frames_in_flight: u32,
    submitter: *mut sv_submitter,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the sv_submitter", submitter)?;
        let device = handles::device(device)?;
        device.run(|| {
            let frames = frames_in_flight.max(1);
            if frames > MOST_FRAMES {
                let doing = "keep frames in flight";
                return Err(Failure::limit(doing, frames.into(), MOST_FRAMES.into()));
            }
            let made = Submitter::new(&device.gpu, frames)?;
            let handle = handles::add(&device, Held(Mutex::new(made)))?;
            // SAFETY: not NULL; the caller's promise.
            unsafe { submitter.write(handle) };
            Ok(())
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Level C: sv_renderer_record_into in a submission of the library's own. Nothing waits on the CPU but for `lock`.
///
/// The submission before with the shot's number of a frame is done. Semaphores live until this one is done.
/// Threads: one at a time for one submitter and for one renderer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_submitter_submit(
    submitter: sv_submitter,
    renderer: sv_renderer,
    shot: *const sv_frame_info,
    target: *const sv_target,
    submission: *const sv_submission,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        let (device, held) = handles::find::<Held>(submitter)?;
        handles::find_on::<renderer::Held>(&device, renderer)?;
        let mut submitter = handles::only(Held::NAME, &held.0)?;
        renderer::with(renderer, |_, inner| {
            // SAFETY: the caller's promise.
            unsafe {
                let taken = Taken::new(shot, inner)?;
                let (target, load) = self::target(target)?;
                let submission = Submission::new(submission)?;
                let locked = submission.locked();
                let lock = submission.lock(&locked);
                let (waits, signals) = (&submission.waits, &submission.signals);
                let renderer = &mut inner.renderer;
                let shot = taken.shot();
                submitter.submit(renderer, &shot, &target, load, lock, waits, signals)?;
            }
            Ok(())
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// sv_volume_record_upload in a submission of the library's own, as number `frame` of the frames in flight.
/// As sv_submitter_submit.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_submitter_upload(
    submitter: sv_submitter,
    volume: sv_volume,
    frame: u32,
    submission: *const sv_submission,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        let (device, held) = handles::find::<Held>(submitter)?;
        let volume = handles::find_on::<volume::Held>(&device, volume)?;
        let mut submitter = handles::only(Held::NAME, &held.0)?;
        device.run(|| {
            // SAFETY: the caller's promise.
            unsafe {
                let submission = Submission::new(submission)?;
                let locked = submission.locked();
                let lock = submission.lock(&locked);
                let (waits, signals) = (&submission.waits, &submission.signals);
                volume.upload(|volume| {
                    submitter.upload(&device.gpu, volume, frame, lock, waits, signals)
                })
            }
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Destroys the handle; what it has submitted is done, or is waited for by sv_device_retire. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_submitter_destroy(
    submitter: sv_submitter,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || handles::remove::<Held>(submitter).map(drop);
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// What a caller's structure says.
pub(super) struct Submission {
    c: sv_submission,
    pub waits: Vec<TimelinePoint>,
    pub signals: Vec<TimelinePoint>,
}

impl Submission {
    /// # Safety
    /// As [`structure::read`] of all that `pointer` points to.
    pub unsafe fn new(pointer: *const sv_submission) -> Result<Self, Failure> {
        // SAFETY: the caller's promise.
        let c = unsafe { structure::read(pointer)? };
        if c.queue.is_null() {
            return Err(Failure::argument("sv_submission.queue is NULL"));
        }
        if c.lock.is_some() != c.unlock.is_some() {
            return Err(Failure::argument(
                "sv_submission: lock and unlock come together, and one of them is NULL",
            ));
        }
        // SAFETY: as above.
        let (waits, signals) = unsafe {
            (
                points("sv_submission.waits", c.waits, c.wait_count)?,
                points("sv_submission.signals", c.signals, c.signal_count)?,
            )
        };
        Ok(Self { c, waits, signals })
    }

    /// Calls what it is given between the host's two functions.
    pub fn locked(&self) -> impl Fn(&mut dyn FnMut()) {
        let (lock, unlock, user) = (self.c.lock, self.c.unlock, self.c.user);
        move |submit| {
            // SAFETY: the host's functions, with what the host gave for them.
            unsafe {
                if let Some(lock) = lock {
                    lock(user);
                }
                submit();
                if let Some(unlock) = unlock {
                    unlock(user);
                }
            }
        }
    }

    pub fn lock<'a>(&self, locked: &'a dyn Fn(&mut dyn FnMut())) -> QueueLock<'a> {
        QueueLock {
            queue: vk::Queue::from_raw(self.c.queue as u64),
            locked,
        }
    }
}

/// # Safety
/// As [`structure::array`].
unsafe fn points(
    name: &str,
    pointer: *const sv_timeline_point,
    count: u64,
) -> Result<Vec<TimelinePoint>, Failure> {
    // SAFETY: the caller's promise.
    let points = unsafe { structure::array(name, pointer, count, MOST_POINTS)? };
    let point = |point: &sv_timeline_point| match point.semaphore {
        0 => Err(Failure::argument(format!("{name}: a semaphore is 0"))),
        semaphore => Ok((vk::Semaphore::from_raw(semaphore), point.value)),
    };
    points.iter().map(point).collect()
}
