//! What a renderer records: levels A and B.

use super::camera::{camera, sv_camera};
use super::images::{sv_target, target};
use super::renderer::{Inner, sv_renderer, with};
use super::status::{Failure, guard, reserved, sv_diagnostic, sv_status};
use super::structure::{self, Versioned};
use super::volume::commands;
use crate::camera::{Camera, HostDepth};
use crate::embed::FrameInfo;
use std::ffi::c_void;

/// One frame of the host's.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_frame_info {
    /// `sizeof(sv_frame_info)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// The eye; NULL: all of the volume from the front.
    pub camera: *const sv_camera,
    /// Which of the frames in flight, from 0: nothing unfinished was recorded with this number.
    pub frame: u32,
    /// 0.
    pub reserved: u32,
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_frame_info {
    const NAME: &'static str = "sv_frame_info";
}

/// A shot of whose camera the caller has the place.
pub(super) struct Taken {
    camera: Camera,
    depth: Option<HostDepth>,
    frame: u32,
}

impl Taken {
    /// # Safety
    /// As [`structure::read`] of all that `pointer` points to.
    pub unsafe fn new(pointer: *const sv_frame_info, inner: &mut Inner) -> Result<Self, Failure> {
        // SAFETY: the caller's promise.
        let (shot, (camera, depth)) = unsafe {
            let shot = structure::read(pointer)?;
            let extent = inner.renderer.extent();
            (shot, camera(shot.camera, inner.volume.grid(), extent)?)
        };
        reserved("sv_frame_info.reserved", shot.reserved)?;
        let class = inner.renderer.class();
        let writes_depth = class.gives_depth && class.target.depth.is_some();
        if depth.is_none() && (class.host_depth || writes_depth) {
            return Err(Failure::argument(
                "sv_frame_info.camera: a renderer with has_host_depth or gives_depth wants SV_CAMERA_MATRICES",
            ));
        }
        Ok(Self {
            camera,
            depth,
            frame: shot.frame,
        })
    }

    pub fn shot(&self) -> FrameInfo<'_> {
        FrameInfo {
            frame: self.frame,
            camera: &self.camera,
            depth: self.depth,
        }
    }
}

/// Level A, first half: records all of a frame that lies outside of the host's rendering. It submits nothing, waits for
/// nothing and makes no Vulkan object.
///
/// `command_buffer` (`VkCommandBuffer`) is recording, outside rendering, for a queue of the device's family, and is
/// submitted in the order in which it was recorded. Depth images are in the layout that was said.
/// Threads: one at a time for one renderer; others beside it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_renderer_record(
    renderer: sv_renderer,
    command_buffer: *mut c_void,
    shot: *const sv_frame_info,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        with(renderer, |_, inner| {
            let cmd = commands(command_buffer)?;
            // SAFETY: the caller's promise.
            unsafe {
                let taken = Taken::new(shot, inner)?;
                Ok(inner.renderer.record(cmd, &taken.shot())?)
            }
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Level A, second half: draws what was recorded for `frame` over what the host has drawn. Bound pipeline, descriptor
/// set 0, viewport and scissor are ours afterwards.
///
/// `command_buffer` is inside rendering to a target of the renderer's class and size, after sv_renderer_record.
/// Threads: one at a time for one renderer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_renderer_draw(
    renderer: sv_renderer,
    command_buffer: *mut c_void,
    frame: u32,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        with(renderer, |_, inner| {
            let cmd = commands(command_buffer)?;
            // SAFETY: the caller's promise.
            unsafe { Ok(inner.renderer.draw(cmd, frame)?) }
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Writes the depth of a picture into the depth attachment, where it is nearer than what is there. Of composites it is
/// where they become half opaque. As sv_renderer_draw, and depth may be written; wants `gives_depth`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_renderer_draw_depth(
    renderer: sv_renderer,
    command_buffer: *mut c_void,
    frame: u32,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        with(renderer, |_, inner| {
            let cmd = commands(command_buffer)?;
            // SAFETY: the caller's promise.
            unsafe { Ok(inner.renderer.draw_depth(cmd, frame)?) }
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Level B: sv_renderer_record and sv_renderer_draw into an image that arrives and leaves as `target` says.
/// As sv_renderer_record; the image lives until `command_buffer` has run.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_renderer_record_into(
    renderer: sv_renderer,
    command_buffer: *mut c_void,
    shot: *const sv_frame_info,
    target: *const sv_target,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        with(renderer, |_, inner| {
            let cmd = commands(command_buffer)?;
            // SAFETY: the caller's promise.
            unsafe {
                let taken = Taken::new(shot, inner)?;
                let (target, load) = self::target(target)?;
                let renderer = &mut inner.renderer;
                Ok(renderer.record_into(cmd, &taken.shot(), &target, load)?)
            }
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}
