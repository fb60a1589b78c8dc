//! Volumes through a staging buffer to the device, a slab at a time.

use crate::gpu::{Buffer, Error, Headless, Memory};
use crate::resident::{GpuVolume, TextureLayout};
use crate::volume::Volume;
use ash::vk;

/// A slab is as many slices as fit into this.
const STAGING_BYTES: u64 = 32 << 20;

/// Makes and fills the textures of volumes on one grid.
pub fn upload(
    device: &mut Headless,
    volumes: &[&Volume],
    layout: TextureLayout,
) -> Result<Vec<GpuVolume>, Error> {
    let made = GpuVolume::several(device.gpu(), volumes, layout)?;
    for (made, volume) in made.iter().zip(volumes) {
        fill(device, made, volume)?;
    }
    Ok(made)
}

fn fill(device: &mut Headless, made: &GpuVolume, volume: &Volume) -> Result<(), Error> {
    let slabs = made.slabs(STAGING_BYTES);
    let bytes = slabs.iter().map(|slab| made.staging_bytes(slab.region));
    let bytes = bytes.max().unwrap_or(0);
    let usage = vk::BufferUsageFlags::TRANSFER_SRC;
    let staging = Buffer::new(device.gpu(), bytes, usage, Memory::Upload, "staging")?;
    for slab in &slabs {
        staging.write(0, &made.staged(volume, slab.region))?;
        // SAFETY: recorded outside rendering; the staging buffer holds this slab; `run` waits.
        device.run(|cmd| unsafe { made.record_upload(cmd, &staging, 0, slab) })?;
    }
    Ok(())
}
