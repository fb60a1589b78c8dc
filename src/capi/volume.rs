//! Voxels of the host's on its device.

use super::device::sv_device;
use super::handles::{self, Kind};
use super::settings::{finite, settings, sv_settings};
use super::status::{Failure, guard, number, reserved, sv_diagnostic, sv_status};
use super::structure::{self, Versioned};
use super::words::{VOXEL_TYPES, word};
use crate::embed;
use crate::volume::{Rescale, Volume, VoxelType, Voxels};
use ash::vk::{self, Handle};
use glam::{DAffine3, DMat4, DVec4};
use half::f16;
use std::ffi::c_void;
use std::sync::{Arc, Mutex, MutexGuard};

/// A volume on a device. 0 is none.
pub type sv_volume = u64;

/// Voxels, x fastest, then y, then z. `value = slope stored + intercept`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_volume_desc {
    /// `sizeof(sv_volume_desc)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// How many there are along x, y and z: 1 or more of each.
    pub dims: [u32; 3],
    /// sv_voxel_type, in the order of bytes of this machine.
    pub voxel_type: u32,
    /// The voxels, without gaps. They are copied before the call returns. Floats that are not finite hold no data.
    pub voxels: *const c_void,
    /// Bytes of them.
    pub voxel_bytes: u64,
    /// Voxel space, in which voxel (i, j, k) covers [i, i + 1) and so on, to the world: columns of a matrix, the last
    /// row of which is (0, 0, 0, 1). All zero: the two are the same.
    pub world_from_voxel: [f64; 16],
    /// 0 is 1.
    pub slope: f64,
    /// Value of a stored 0.
    pub intercept: f64,
    /// Not 0: stored numbers like `fill` hold no data.
    pub has_fill: u32,
    /// What stands where there is no data.
    pub fill: f64,
    /// The settings of the renderers that will draw it, of which technique, filter, light and empty space count; or
    /// NULL.
    pub settings: *const sv_settings,
    /// Not 0: `value_range` holds all values that the volume has and will get by updates. 0: it is that of the voxels.
    pub has_value_range: u32,
    /// 0.
    pub reserved: u32,
    /// Smallest and largest value.
    pub value_range: [f64; 2],
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_volume_desc {
    const NAME: &'static str = "sv_volume_desc";
}

/// What is there of a volume. Calls wait for each other here: none of them calls the host back.
pub(super) struct Held(Mutex<Inner>);

struct Inner {
    /// Missing while it is uploaded, which may call the host.
    volume: Option<Arc<embed::Volume>>,
    source: Source,
}

/// How the host's numbers become values: those of updates too.
#[derive(Clone, Copy)]
pub(super) struct Source {
    pub kind: VoxelType,
    pub rescale: Rescale,
    pub fill: Option<f64>,
}

impl Kind for Held {
    const NUMBER: u64 = 2;
    const NAME: &'static str = "sv_volume";
}

impl Held {
    fn new(volume: embed::Volume, source: Source) -> Self {
        Self(Mutex::new(Inner {
            volume: Some(Arc::new(volume)),
            source,
        }))
    }

    /// How its voxels are told.
    pub fn source(&self) -> Result<Source, Failure> {
        Ok(self.lock()?.source)
    }

    fn lock(&self) -> Result<MutexGuard<'_, Inner>, Failure> {
        self.0.lock().map_err(|_| {
            Failure::state("this sv_volume met a mistake of stratavox before: destroy it")
        })
    }

    fn volume(&self) -> Result<Arc<embed::Volume>, Failure> {
        self.lock()?.volume.clone().ok_or_else(busy)
    }

    /// For a renderer, which keeps it.
    pub fn share(&self) -> Result<Arc<embed::Volume>, Failure> {
        let volume = self.volume()?;
        match volume.upload_parts()? {
            0 => Ok(volume),
            _ => Err(Failure::state(
                "the volume is not uploaded: sv_volume_record_upload comes before its renderers",
            )),
        }
    }

    /// Uploads it, once, or a part of it.
    pub fn upload<T>(
        &self,
        work: impl FnOnce(&mut embed::Volume) -> Result<T, embed::Error>,
    ) -> Result<T, Failure> {
        let mut taken = self.lock()?.volume.take().ok_or_else(busy)?;
        let done = match Arc::get_mut(&mut taken) {
            Some(volume) => work(volume).map_err(Failure::from),
            // Renderers have it, or another call looks at it.
            None => match taken.upload_parts()? {
                0 => Err(embed::Error::Uploaded.into()),
                _ => Err(busy()),
            },
        };
        self.lock()?.volume = Some(taken);
        done
    }
}

fn busy() -> Failure {
    Failure::state("another thread uses this sv_volume, or a call of the host's back")
}

/// Makes textures for voxels, which are copied to where the upload finds them. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_volume_create(
    device: sv_device,
    desc: *const sv_volume_desc,
    volume: *mut sv_volume,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the sv_volume", volume)?;
        let device = handles::device(device)?;
        device.run(|| {
            // SAFETY: the caller's promise.
            let desc = unsafe { structure::read(desc)? };
            let (kind, bytes) = check(&desc, device.gpu.limits().max_heap_bytes)?;
            let range = [0.0, 1.0];
            // SAFETY: as above.
            let settings = unsafe { settings(desc.settings, range)? };
            let affine = affine("sv_volume_desc.world_from_voxel", &desc.world_from_voxel)?;
            // SAFETY: as many bytes as the caller says, which are as many as there are voxels.
            let bytes = unsafe { std::slice::from_raw_parts(desc.voxels.cast::<u8>(), bytes) };
            let voxels = voxels(kind, bytes)?;
            let rescale = Rescale {
                slope: if desc.slope == 0.0 { 1.0 } else { desc.slope },
                intercept: desc.intercept,
            };
            let fill = (desc.has_fill != 0).then_some(desc.fill);
            let mut read = Volume::from_voxels(desc.dims, affine, voxels, rescale, fill)?;
            read.value_range = value_range(&desc, read.value_range)?;
            let made = embed::Volume::new(&device.gpu, &read, &settings)?;
            let source = Source {
                kind,
                rescale,
                fill,
            };
            let handle = handles::add(&device, Held::new(made, source))?;
            // SAFETY: not NULL; the caller's promise.
            unsafe { volume.write(handle) };
            Ok(())
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Records the upload, once, before anything is made that draws the volume. What it is staged in is freed by
/// sv_device_retire, if sv_device_announce came before.
///
/// `command_buffer` (`VkCommandBuffer`) is recording, outside rendering, and is submitted before what draws the volume.
/// Threads: any, one at a time for one volume.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_volume_record_upload(
    volume: sv_volume,
    command_buffer: *mut c_void,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        let (device, held) = handles::find::<Held>(volume)?;
        let cmd = commands(command_buffer)?;
        // SAFETY: the caller's promise.
        device.run(|| held.upload(|volume| unsafe { volume.record_upload(&device.gpu, cmd) }))
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Records the next `count` pieces of the upload, one at least and none of them long, and tells how many are left.
/// Where there are none, the volume is uploaded. As sv_volume_record_upload, of all parts, which are submitted in their
/// order.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_volume_record_upload_part(
    volume: sv_volume,
    command_buffer: *mut c_void,
    count: u64,
    left: *mut u64,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the number of pieces", left)?;
        let (device, held) = handles::find::<Held>(volume)?;
        let cmd = commands(command_buffer)?;
        let part = |volume: &mut embed::Volume| {
            // SAFETY: the caller's promise.
            unsafe { volume.record_upload_part(&device.gpu, cmd, count) }
        };
        let found = device.run(|| held.upload(part))?;
        // SAFETY: not NULL; the caller's promise.
        unsafe { left.write(found) };
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// The smallest and the largest value that is no hole: two doubles. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_volume_value_range(
    volume: sv_volume,
    range: *mut f64,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the two values", range)?;
        let (_, held) = handles::find::<Held>(volume)?;
        let found = held.volume()?.value_range();
        // SAFETY: not NULL; the caller's promise.
        unsafe { range.cast::<[f64; 2]>().write(found) };
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Destroys the handle. Renderers that draw the volume keep it; else it waits for sv_device_retire. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_volume_destroy(
    volume: sv_volume,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || handles::remove::<Held>(volume).map(drop);
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// A command buffer of the host's.
pub(super) fn commands(pointer: *mut c_void) -> Result<vk::CommandBuffer, Failure> {
    match pointer.is_null() {
        true => Err(Failure::argument("the command buffer is NULL")),
        false => Ok(vk::CommandBuffer::from_raw(pointer as u64)),
    }
}

/// The type of the voxels and how many bytes they have.
fn check(desc: &sv_volume_desc, most_bytes: u64) -> Result<(VoxelType, usize), Failure> {
    let kind = word("sv_volume_desc.voxel_type", &VOXEL_TYPES, desc.voxel_type)?;
    if desc.dims.contains(&0) {
        let text = format!("sv_volume_desc.dims: {:?}, wanted 1 or more", desc.dims);
        return Err(Failure::argument(text));
    }
    let each = kind.bytes() as u64;
    let product = |bytes: u64, n: &u32| bytes.checked_mul(u64::from(*n));
    let wanted = desc.dims.iter().try_fold(each, product);
    let wanted = wanted.unwrap_or(u64::MAX);
    if wanted > most_bytes {
        let doing = "make a volume in the device's largest heap";
        return Err(Failure::limit(doing, wanted, most_bytes));
    }
    if wanted != desc.voxel_bytes {
        return Err(Failure::argument(format!(
            "sv_volume_desc.voxel_bytes: {:?} voxels of {} have {wanted}, found {}",
            desc.dims,
            kind.name(),
            desc.voxel_bytes
        )));
    }
    if desc.voxels.is_null() {
        return Err(Failure::argument("sv_volume_desc.voxels is NULL"));
    }
    for (name, found) in [
        ("sv_volume_desc.slope", desc.slope),
        ("sv_volume_desc.intercept", desc.intercept),
    ] {
        number(name, "a finite number", found, found.is_finite())?;
    }
    Ok((kind, wanted as usize))
}

/// That of the voxels, or a wider one that the caller tells.
fn value_range(desc: &sv_volume_desc, found: [f64; 2]) -> Result<[f64; 2], Failure> {
    let [low, high] = found;
    let is_finite = low.is_finite() && high.is_finite();
    let bad = if low.is_finite() { high } else { low };
    number("a rescaled value", "a finite number", bad, is_finite)?;
    reserved("sv_volume_desc.reserved", desc.reserved)?;
    if desc.has_value_range == 0 {
        return Ok(found);
    }
    let [least, most] = desc.value_range;
    let holds = least.is_finite() && most.is_finite() && least <= low && high <= most;
    match holds {
        true => Ok([least, most]),
        false => Err(Failure::argument(format!(
            "sv_volume_desc.value_range: wanted finite numbers around {low} and {high}, found {least} and {most}"
        ))),
    }
}

/// An invertible transform from columns; all zero is the identity.
pub(super) fn affine(name: &str, columns: &[f64; 16]) -> Result<DAffine3, Failure> {
    if columns == &[0.0; 16] {
        return Ok(DAffine3::IDENTITY);
    }
    let matrix = DMat4::from_cols_array(columns);
    for column in 0..4 {
        finite(name, matrix.col(column).truncate().to_array())?;
    }
    if matrix.row(3) != DVec4::W {
        let text = format!(
            "{name}: wanted (0, 0, 0, 1) as the last row, found {}",
            matrix.row(3)
        );
        return Err(Failure::argument(text));
    }
    Ok(DAffine3::from_mat4(matrix))
}

/// A copy of the caller's voxels, as they are kept.
pub(super) fn voxels(kind: VoxelType, bytes: &[u8]) -> Result<Voxels, Failure> {
    macro_rules! copied {
        ($number:ty, $kept:expr) => {{
            let (numbers, _) = bytes.as_chunks::<{ size_of::<$number>() }>();
            let mut copy = Vec::new();
            copy.try_reserve_exact(numbers.len()).map_err(|_| {
                let text = format!("no memory of the host for {} voxels", numbers.len());
                Failure::new(sv_status::SV_E_MEMORY, text)
            })?;
            let kept = $kept;
            let numbers = numbers.iter().copied();
            copy.extend(numbers.map(|bytes| kept(<$number>::from_ne_bytes(bytes))));
            copy
        }};
    }
    Ok(match kind {
        VoxelType::U8 => Voxels::U8(copied!(u8, |n| n)),
        VoxelType::I8 => Voxels::I8(copied!(i8, |n| n)),
        VoxelType::U16 => Voxels::U16(copied!(u16, |n| n)),
        VoxelType::I16 => Voxels::I16(copied!(i16, |n| n)),
        VoxelType::F16 => Voxels::F16(copied!(f16, |n| n)),
        VoxelType::F32 => Voxels::F32(copied!(f32, |n| n)),
        VoxelType::U32 => Voxels::F32(copied!(u32, |n| n as f32)),
        VoxelType::I32 => Voxels::F32(copied!(i32, |n| n as f32)),
        VoxelType::F64 => Voxels::F32(copied!(f64, |n| n as f32)),
        VoxelType::U64 | VoxelType::I64 => unreachable!("no number of C stands for it"),
    })
}
