//! What a volume will take, told before it is there.

use super::device::sv_device;
use super::handles;
use super::settings::settings;
use super::status::{Failure, guard, sv_diagnostic, sv_status};
use super::structure::{self, Versioned};
use super::volume::sv_volume_desc;
use super::words::{VOXEL_TYPES, word};
use crate::embed;
use crate::volume::VoxelType;
use std::ffi::c_void;

/// What a volume will take.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_plan {
    /// `sizeof(sv_plan)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// Bytes of its textures and of what is known of its empty space, without what the driver pads them by.
    pub device_bytes: u64,
    /// Bytes of the buffer that it is staged in until its upload has run.
    pub staging_bytes: u64,
    /// Into how many bricks the limits of the device cut it.
    pub bricks: u64,
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_plan {
    const NAME: &'static str = "sv_plan";
}

/// What a volume will take: of `desc`, `dims`, `voxel_type`, `has_fill` (there will be holes) and `settings` count, and
/// `voxels` may be NULL. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_volume_plan(
    device: sv_device,
    desc: *const sv_volume_desc,
    plan: *mut sv_plan,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        // SAFETY: the caller's promise.
        unsafe { structure::check_room(plan.cast_const())? };
        let device = handles::device(device)?;
        device.run(|| {
            // SAFETY: the caller's promise.
            let (desc, settings) = unsafe {
                let desc = structure::read(desc)?;
                (desc, settings(desc.settings, [0.0, 1.0])?)
            };
            let kind = word("sv_volume_desc.voxel_type", &VOXEL_TYPES, desc.voxel_type)?;
            if desc.dims.contains(&0) {
                let text = format!("sv_volume_desc.dims: {:?}, wanted 1 or more", desc.dims);
                return Err(Failure::argument(text));
            }
            let stored = match kind.is_kept_exactly() {
                true => kind,
                false => VoxelType::F32,
            };
            let holes = desc.has_fill != 0;
            let found = embed::Volume::plan(&device.gpu, desc.dims, stored, holes, &settings)?;
            let told = sv_plan {
                struct_size: 0,
                next: std::ptr::null(),
                device_bytes: found.device_bytes,
                staging_bytes: found.staging_bytes,
                bricks: found.bricks as u64,
            };
            // SAFETY: the caller's promise.
            unsafe { structure::write(plan, &told) }
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}
