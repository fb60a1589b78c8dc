//! New voxels of a box of a volume that is drawn.

use super::device::Device;
use super::handles::{self, Kind};
use super::status::{Failure, guard, sv_diagnostic, sv_status};
use super::structure::{self, Versioned};
use super::volume::{self, commands, sv_volume, voxels};
use crate::embed;
use crate::volume::{Volume, VoxelBox, VoxelPart};
use glam::DAffine3;
use std::ffi::c_void;
use std::sync::Mutex;

/// New voxels on their way into a volume. 0 is none.
pub type sv_update = u64;

/// New voxels of a box.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_update_desc {
    /// `sizeof(sv_update_desc)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// The first voxel of the box, along x, y and z.
    pub origin: [u32; 3],
    /// How many there are: 1 or more of each.
    pub extent: [u32; 3],
    /// All voxels of the changed volume, of the same type, without gaps. Those of the box are read, and some around it:
    /// beside the box nothing has changed.
    pub voxels: *const c_void,
    /// Bytes of them: as many as the volume was made of.
    pub voxel_bytes: u64,
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_update_desc {
    const NAME: &'static str = "sv_update_desc";
}

struct Held(Mutex<Option<embed::Update>>);

impl Kind for Held {
    const NUMBER: u64 = 6;
    const NAME: &'static str = "sv_update";
}

/// Stages new voxels of a box of a volume that was uploaded: a copy of them, where the recording finds it. Their values
/// lie in the volume's `value_range`; where it was made without holes they have none; filters that read coefficients of
/// a spline are SV_E_UNSUPPORTED. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_volume_stage_update(
    volume: sv_volume,
    desc: *const sv_update_desc,
    update: *mut sv_update,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the sv_update", update)?;
        let (device, held) = handles::find::<volume::Held>(volume)?;
        device.run(|| {
            // SAFETY: the caller's promise.
            let desc = unsafe { structure::read(desc)? };
            let (volume, source) = (held.share()?, held.source()?);
            let dims = volume.grid().dims;
            let region = region(&desc, dims)?;
            let reads = volume.update_reads(region)?;
            let each = source.kind.bytes();
            let wanted = dims.iter().fold(each as u64, |bytes, &n| bytes * u64::from(n));
            if desc.voxels.is_null() || desc.voxel_bytes != wanted {
                return Err(Failure::argument(format!(
                    "sv_update_desc.voxels: wanted {wanted} bytes, those of the whole volume, found {}",
                    if desc.voxels.is_null() { 0 } else { desc.voxel_bytes }
                )));
            }
            // SAFETY: as many bytes as the caller says.
            let all = unsafe {
                std::slice::from_raw_parts(desc.voxels.cast::<u8>(), wanted as usize)
            };
            let taken = voxels(source.kind, &rows(all, dims, each, reads))?;
            let place = DAffine3::IDENTITY;
            let (rescale, fill) = (source.rescale, source.fill);
            let taken = Volume::from_voxels(reads.dims(), place, taken, rescale, fill)?;
            let part = VoxelPart {
                held: reads,
                voxels: &taken.voxels,
                validity: taken.validity.as_deref(),
            };
            let made = volume.stage_update(region, part)?;
            let handle = handles::add(&device, Held(Mutex::new(Some(made))))?;
            // SAFETY: not NULL; the caller's promise.
            unsafe { update.write(handle) };
            Ok(())
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Records an update between the frames that were recorded before, which show the old voxels, and those recorded later,
/// which show the new ones. Updates of one volume are recorded as they were staged: SV_E_STATE where another comes
/// first, or was destroyed, and this was staged after it. The handle of one that is recorded is used up; what it is
/// staged in is freed by sv_device_retire, if sv_device_announce came before.
///
/// `command_buffer` (`VkCommandBuffer`) is recording, outside rendering, and is submitted to the queue that draws the
/// volume, in the order of recording. Threads: any, one at a time for one volume.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_volume_record_update(
    volume: sv_volume,
    command_buffer: *mut c_void,
    update: sv_update,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        let (device, held) = handles::find::<volume::Held>(volume)?;
        let staged = handles::find_on::<Held>(&device, update)?;
        let cmd = commands(command_buffer)?;
        device.run(|| {
            let volume = held.share()?;
            let mut staged = handles::only(Held::NAME, &staged.0)?;
            check(&volume, staged.as_ref())?;
            handles::remove::<Held>(update)?;
            let Some(staged) = staged.take() else {
                unreachable!("looked at just now");
            };
            // SAFETY: the caller's promise.
            unsafe { volume.record_update(cmd, staged)? };
            Ok(())
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Records the next `count` pieces of an update, one at least and none of them long, and tells how many are left. Where
/// there are none, the handle is used up. Until then the volume is not drawn (SV_E_STATE); where the update is
/// destroyed before, that lasts until another one is recorded that changes all of its voxels. As
/// sv_volume_record_update, of all parts, which are submitted in their order.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_volume_record_update_part(
    volume: sv_volume,
    command_buffer: *mut c_void,
    update: sv_update,
    count: u64,
    left: *mut u64,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the number of pieces", left)?;
        let (device, held) = handles::find::<volume::Held>(volume)?;
        let cmd = commands(command_buffer)?;
        let found = device.run(|| {
            with(&device, update, &held, |volume, staged| {
                // SAFETY: the caller's promise.
                Ok(unsafe { volume.record_update_part(cmd, staged, count)? })
            })
        })?;
        // SAFETY: not NULL; the caller's promise.
        unsafe { left.write(found) };
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// What a call does with an update, which is used up where nothing of it is left.
pub(super) fn with<T>(
    device: &Device,
    update: sv_update,
    volume: &volume::Held,
    work: impl FnOnce(&embed::Volume, &mut embed::Update) -> Result<T, Failure>,
) -> Result<T, Failure> {
    let held = handles::find_on::<Held>(device, update)?;
    let volume = volume.share()?;
    let mut staged = handles::only(Held::NAME, &held.0)?;
    check(&volume, staged.as_ref())?;
    let Some(there) = staged.as_mut() else {
        unreachable!("looked at just now");
    };
    let done = work(&volume, there);
    if there.parts() == 0 {
        *staged = None;
        handles::remove::<Held>(update)?;
    }
    done
}

/// Whether it is an update of the volume, and its turn.
fn check(volume: &embed::Volume, staged: Option<&embed::Update>) -> Result<(), Failure> {
    match staged.filter(|staged| staged.is_of(volume)) {
        Some(staged) => Ok(volume.check_update(staged)?),
        None => Err(Failure::argument(
            "sv_update: the handle is of one that was staged for another sv_volume, or is recorded",
        )),
    }
}

/// Destroys the handle of an update that is not recorded: those that were staged after it will not be recorded any
/// more, for they were staged from voxels that hold these. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_update_destroy(
    update: sv_update,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || handles::remove::<Held>(update).map(drop);
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// The box, inside of the volume.
fn region(desc: &sv_update_desc, dims: [u32; 3]) -> Result<VoxelBox, Failure> {
    let (min, count) = (desc.origin, desc.extent);
    let is_inside = (0..3).all(|k| {
        let end = min[k].checked_add(count[k]);
        count[k] > 0 && end.is_some_and(|end| end <= dims[k])
    });
    match is_inside {
        true => Ok(VoxelBox {
            min,
            max: std::array::from_fn(|k| min[k] + count[k]),
        }),
        false => Err(Failure::argument(format!(
            "sv_update_desc: wanted a box of one voxel or more in {dims:?}, found {count:?} from {min:?} on"
        ))),
    }
}

/// The bytes of a box of the voxels.
fn rows(all: &[u8], [nx, ny, _]: [u32; 3], each: usize, part: VoxelBox) -> Vec<u8> {
    let length = part.dims()[0] as usize * each;
    let first = |y: u32, z: u32| {
        let row = z as usize * ny as usize + y as usize;
        (row * nx as usize + part.min[0] as usize) * each
    };
    let [_, ys, zs] = [0, 1, 2].map(|k| part.min[k]..part.max[k]);
    let firsts = zs.flat_map(|z| ys.clone().map(move |y| (y, z)));
    let rows = firsts.map(|(y, z)| &all[first(y, z)..first(y, z) + length]);
    rows.flatten().copied().collect()
}
