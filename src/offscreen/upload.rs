//! Volumes through a staging buffer to the device, a slab at a time.

use super::time_slices::{TimeSlices, Work};
use crate::gpu::{Buffer, Error, Headless, Memory};
use crate::resident::{GpuVolume, KeptGradients, KeptOperator, Slab, Texels, TextureLayout};
use crate::technique::GradientSource;
use crate::technique::cost::{fetches_of_cells, ms_of_fetches};
use crate::volume::{Coefficients, Spline, Volume};
use ash::vk;
use std::panic::resume_unwind;
use std::thread;

/// A slab is as many slices as fit into this: small enough to stay in the caches of a CPU while it is copied.
const STAGING_BYTES: u64 = 4 << 20;

/// A value that is neither filtered nor classified is the less part of a look.
const LOOKS_OF_A_VALUE: f64 = 0.1;

/// Makes and fills the textures of volumes: their voxels, or the coefficients of their splines.
pub fn upload(
    device: &mut Headless,
    volumes: &[&Volume],
    layout: TextureLayout,
    spline: Option<Spline>,
) -> Result<Vec<GpuVolume>, Error> {
    let Some(spline) = spline else {
        let made = together(device, volumes, layout)?;
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

/// Those on the grid of the first are cut into the same bricks as it is.
fn together(
    device: &Headless,
    volumes: &[&Volume],
    layout: TextureLayout,
) -> Result<Vec<GpuVolume>, Error> {
    let is_shared = |volume: &Volume| volume.grid() == volumes[0].grid();
    if volumes.iter().all(|volume| is_shared(volume)) {
        return GpuVolume::several(device.gpu(), volumes, layout);
    }
    let each = |volume: &&Volume| GpuVolume::new(device.gpu(), volume, layout);
    volumes.iter().map(each).collect()
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
    slices: &mut TimeSlices,
    volume: &mut GpuVolume,
    operator: KeptOperator,
) -> Result<(), Error> {
    let kept = KeptGradients::new(device.gpu(), volume, operator)?;
    let values = match operator {
        KeptOperator::Differences => 15.0,
        KeptOperator::Sobel => 27.0,
    };
    let cells = volume.bricks().iter().map(|brick| &brick.cell);
    let fetches = LOOKS_OF_A_VALUE * fetches_of_cells(cells, values);
    let work = Work::beside(0..kept.group_count()?, ms_of_fetches(device.gpu(), fetches));
    slices.run(device, None, work, |cmd, _, part| {
        // SAFETY: recorded outside rendering, parts in order; the volume has been uploaded; `run` waits.
        unsafe { kept.record_part(cmd, part) }
    })?;
    volume.keep_gradients(kept);
    Ok(())
}

/// While the device copies one slab, the next is staged.
pub fn fill(device: &mut Headless, made: &GpuVolume, volume: &Volume) -> Result<(), Error> {
    let slabs = made.slabs(STAGING_BYTES);
    let bytes = slabs.iter().map(|slab| made.staging_bytes(slab.region));
    // Of a volume without texels and holes none.
    let bytes = bytes.max().unwrap_or(0).max(4);
    let usage = vk::BufferUsageFlags::TRANSFER_SRC;
    let buffers = (0..slabs.len().min(2))
        .map(|_| Buffer::new(device.gpu(), bytes, usage, Memory::Upload, "staging"))
        .collect::<Result<Vec<_>, _>>()?;
    let staging = |index: usize| &buffers[index % 2];
    let stage = |index: usize, slab: &Slab| {
        let bytes = made.staging_bytes(slab.region);
        staging(index).write_with(0, bytes, |out| made.write_staged(volume, slab.region, out))
    };
    if let Some(first) = slabs.first() {
        stage(0, first)?;
    }
    for (index, slab) in slabs.iter().enumerate() {
        thread::scope(|scope| {
            let next = slabs.get(index + 1);
            let next = next.map(|next| scope.spawn(move || stage(index + 1, next)));
            // SAFETY: recorded outside rendering; the staging buffer holds this slab, and the thread writes into the
            // other one; `run` waits.
            device.run(|cmd| unsafe { made.record_upload(cmd, staging(index), 0, slab) })?;
            next.map_or(Ok(()), |next| {
                next.join().unwrap_or_else(|fault| resume_unwind(fault))
            })
        })?;
    }
    Ok(())
}
