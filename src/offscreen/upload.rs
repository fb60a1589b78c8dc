//! Volumes through a staging buffer to the device, a slab at a time.

use crate::gpu::{Buffer, Error, Headless, Memory};
use crate::resident::{GpuVolume, KeptGradients, KeptOperator, Texels, TextureLayout};
use crate::technique::GradientSource;
use crate::volume::{Coefficients, Spline, Volume};
use ash::vk;

/// A slab is as many slices as fit into this: small enough to stay in the caches of a CPU while it is copied.
const STAGING_BYTES: u64 = 4 << 20;

/// Makes and fills the textures of volumes on one grid: their voxels, or the coefficients of their splines.
pub fn upload(
    device: &mut Headless,
    volumes: &[&Volume],
    layout: TextureLayout,
    spline: Option<Spline>,
) -> Result<Vec<GpuVolume>, Error> {
    let Some(spline) = spline else {
        let made = GpuVolume::several(device.gpu(), volumes, layout)?;
        for (made, volume) in made.iter().zip(volumes) {
            fill(device, made, volume)?;
        }
        return Ok(made);
    };
    // One after the other: coefficients are larger than voxels.
    let of_spline = |volume: &&Volume| {
        let coefficients = Coefficients::new(volume, spline, layout.filtered_axes());
        let made = GpuVolume::of_coefficients(device.gpu(), &coefficients, layout)?;
        fill(device, &made, coefficients.volume())?;
        Ok(made)
    };
    volumes.iter().map(of_spline).collect()
}

/// The same of one volume, and what its gradients are made of beside it.
pub fn upload_with_gradient_source(
    device: &mut Headless,
    volume: &Volume,
    layout: TextureLayout,
    spline: Option<Spline>,
    source: GradientSource,
) -> Result<GpuVolume, Error> {
    let of_spline = |spline, axes| Coefficients::new(volume, spline, axes);
    let values = spline.map(|spline| of_spline(spline, layout.filtered_axes()));
    let source = source.spline().map(|spline| of_spline(spline, [true; 3]));
    let [values, source] = [&values, &source].map(|coefficients| {
        let texels = coefficients.as_ref().map(Texels::Coefficients);
        texels.unwrap_or(Texels::Voxels(volume))
    });
    let made = GpuVolume::with_gradient_source(device.gpu(), values, source, layout)?;
    fill(device, &made, values.volume())?;
    let beside = made.gradient_source().expect("made so");
    fill(device, beside, source.volume())?;
    Ok(made)
}

/// Makes the gradients of a volume and keeps them in the place of what they were made of beside it.
pub fn keep(
    device: &mut Headless,
    volume: &mut GpuVolume,
    operator: KeptOperator,
) -> Result<(), Error> {
    let kept = KeptGradients::new(device.gpu(), volume, operator)?;
    // SAFETY: recorded outside rendering; the volume has been uploaded; `run` waits.
    device.run(|cmd| unsafe { kept.record(cmd) })?;
    volume.keep_gradients(kept);
    Ok(())
}

fn fill(device: &mut Headless, made: &GpuVolume, volume: &Volume) -> Result<(), Error> {
    let slabs = made.slabs(STAGING_BYTES);
    let bytes = slabs.iter().map(|slab| made.staging_bytes(slab.region));
    let bytes = bytes.max().unwrap_or(0);
    let usage = vk::BufferUsageFlags::TRANSFER_SRC;
    let staging = Buffer::new(device.gpu(), bytes, usage, Memory::Upload, "staging")?;
    for slab in &slabs {
        staging.write_with(0, made.staging_bytes(slab.region), |out| {
            made.write_staged(volume, slab.region, out);
        })?;
        // SAFETY: recorded outside rendering; the staging buffer holds this slab; `run` waits.
        device.run(|cmd| unsafe { made.record_upload(cmd, &staging, 0, slab) })?;
    }
    Ok(())
}
