//! Volumes through a staging buffer to the device, a slab at a time.

use crate::gpu::{Buffer, Error, Headless, Memory, Use};
use crate::resident::{GpuMask, GpuStack, GpuVolume};
use crate::volume::{Volume, VoxelBox};
use ash::vk;

/// A slab is as many slices as fit into this.
const STAGING_BYTES: u64 = 32 << 20;

/// Uploads all of a volume.
pub fn upload_volume(device: &mut Headless, volume: &Volume) -> Result<GpuVolume, Error> {
    let made = GpuVolume::new(device.gpu(), volume)?;
    let slab = |z: [u32; 2]| {
        let [x, y, _] = volume.dims;
        VoxelBox {
            min: [0, 0, z[0]],
            max: [x, y, z[1]],
        }
    };
    slabs(
        device,
        volume.dims[2],
        made.staging_bytes(slab([0, 1])),
        |z, before| {
            let record = {
                let made = &made;
                move |cmd, staging: &Buffer| {
                    // SAFETY: `slabs` records outside rendering, has filled the staging buffer with these bytes,
                    // and waits before anything is dropped.
                    unsafe { made.record_upload(cmd, staging, slab(z), before) }
                }
            };
            (made.staged(volume, slab(z)), record)
        },
    )?;
    Ok(made)
}

/// Uploads the mask of a volume with holes.
pub fn upload_mask(
    device: &mut Headless,
    volume: &Volume,
    validity: &[u8],
) -> Result<GpuMask, Error> {
    let made = GpuMask::new(device.gpu(), volume)?;
    let slab = |z: [u32; 2]| {
        let [x, y, _] = volume.dims;
        VoxelBox {
            min: [0, 0, z[0]],
            max: [x, y, z[1]],
        }
    };
    let slice_bytes = u64::from(volume.dims[0]) * u64::from(volume.dims[1]);
    slabs(device, volume.dims[2], slice_bytes, |z, before| {
        let record = {
            let made = &made;
            move |cmd, staging: &Buffer| {
                // SAFETY: as in `upload_volume`.
                unsafe { made.record_upload(cmd, staging, slab(z), before) }
            }
        };
        (made.staged(validity, volume, slab(z)), record)
    })?;
    Ok(made)
}

/// Uploads the stack along one axis.
pub fn upload_stack(
    device: &mut Headless,
    volume: &Volume,
    axis: usize,
) -> Result<GpuStack, Error> {
    let made = GpuStack::new(device.gpu(), volume, axis)?;
    slabs(
        device,
        volume.dims[axis],
        made.staging_bytes(&(0..1)),
        |[first, end], before| {
            let record = {
                let made = &made;
                move |cmd, staging: &Buffer| {
                    // SAFETY: as in `upload_volume`.
                    unsafe { made.record_upload(cmd, staging, first..end, before) }
                }
            };
            (made.staged(volume, first..end), record)
        },
    )?;
    Ok(made)
}

/// Fills a staging buffer with one slab of slices after the other and records its copy.
fn slabs<Record>(
    device: &mut Headless,
    slices: u32,
    slice_bytes: u64,
    stage: impl Fn([u32; 2], Use) -> (Vec<u8>, Record),
) -> Result<(), Error>
where
    Record: FnOnce(vk::CommandBuffer, &Buffer) -> Result<(), Error>,
{
    let per_slab = (STAGING_BYTES / slice_bytes).clamp(1, slices.into()) as u32;
    let bytes = u64::from(per_slab) * slice_bytes;
    let usage = vk::BufferUsageFlags::TRANSFER_SRC;
    let staging = Buffer::new(device.gpu(), bytes, usage, Memory::Upload, "staging")?;
    for first in (0..slices).step_by(per_slab as usize) {
        let before = if first == 0 {
            Use::Nothing
        } else {
            Use::Sampled
        };
        let (texels, record) = stage([first, (first + per_slab).min(slices)], before);
        staging.write(0, &texels)?;
        device.run(|cmd| record(cmd, &staging))?;
    }
    Ok(())
}
