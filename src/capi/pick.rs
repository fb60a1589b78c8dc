//! What lies under a pixel.

use super::renderer::{sv_renderer, with};
use super::status::{guard, sv_diagnostic, sv_status};
use super::structure::{self, Versioned};
use super::volume::commands;
use std::ffi::c_void;

/// What lies under a pixel: where a composite has become half opaque, the first surface, the place of a maximum.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_pick {
    /// `sizeof(sv_pick)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// 0: nothing is there, and all that follows is 0.
    pub is_hit: u32,
    /// 0: MIDA and slabs have no value.
    pub has_value: u32,
    /// 0: projecting modes have no colour yet, and slices none beside their depth.
    pub has_color: u32,
    /// 0.
    pub reserved: u32,
    /// World length from where the ray starts.
    pub distance: f64,
    /// The place in the world.
    pub position: [f64; 3],
    /// The projected value, that of the surface, or of the sample that made a composite half opaque; of a map of labels
    /// the label.
    pub value: f64,
    /// Premultiplied colour and alpha.
    pub color: [f32; 4],
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_pick {
    const NAME: &'static str = "sv_pick";
}

/// Records the copy of what lies under a pixel, for sv_renderer_pick when the frame is done.
/// As sv_renderer_record, after it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_renderer_record_pick(
    renderer: sv_renderer,
    command_buffer: *mut c_void,
    frame: u32,
    x: u32,
    y: u32,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        with(renderer, |_, inner| {
            let cmd = commands(command_buffer)?;
            // SAFETY: the caller's promise.
            unsafe { inner.renderer.record_pick(cmd, frame, [x, y])? };
            Ok(())
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// What lay under a pixel of a frame that is done, for which sv_renderer_record_pick was recorded with the same pixel.
/// Threads: one at a time for one renderer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_renderer_pick(
    renderer: sv_renderer,
    frame: u32,
    x: u32,
    y: u32,
    pick: *mut sv_pick,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        // SAFETY: the caller's promise.
        unsafe { structure::check_room(pick.cast_const())? };
        with(renderer, |_, inner| {
            let found = inner.renderer.pick(frame, [x, y])?;
            let mut told = sv_pick {
                struct_size: 0,
                next: std::ptr::null(),
                is_hit: 0,
                has_value: 0,
                has_color: 0,
                reserved: 0,
                distance: 0.0,
                position: [0.0; 3],
                value: 0.0,
                color: [0.0; 4],
            };
            if let Some(found) = found {
                told.is_hit = 1;
                told.has_value = found.value.is_some().into();
                told.has_color = found.color.is_some().into();
                told.distance = found.distance;
                told.position = found.position.to_array();
                told.value = found.value.unwrap_or_default();
                told.color = found.color.unwrap_or_default();
            }
            // SAFETY: the caller's promise.
            unsafe { structure::write(pick, &told) }
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}
