//! Noise filters on the device, a slab of slices at a time with as many more on both sides as the kernel reaches, and
//! of a slab so many rows that no dispatch takes long: a driver on the CPU does some 10^8 looks in a tenth of a second.

use crate::gpu::{
    Bindings, Buffer, ComputePipeline, Error, Headless, Memory, ParameterRing, Resource, Use,
    buffer_barrier,
};
use crate::shaders::{Denoise as Parameters, DenoiseFields, shader};
use crate::volume::{Denoise, Pass, Volume, with_numbers};
use ash::vk;
use std::sync::Arc;

/// A buffer holds as many slices as fit into this.
const SLAB_BYTES: u64 = 32 << 20;

/// Numbers that a dispatch may look at.
const MAX_LOOKS: u64 = 1 << 25;

/// `volume` without noise, as [`Denoise::denoised`] makes it on the CPU.
///
/// # Errors
/// Those of the device: a limit, no memory.
pub fn denoised(device: &mut Headless, volume: &Volume, filter: &Denoise) -> Result<Volume, Error> {
    let mut numbers: Vec<f32> = (0..volume.voxels.len())
        .map(|i| volume.voxels.stored(i))
        .collect();
    for pass in filter.passes(volume) {
        numbers = run(device, volume.dims, &numbers, &pass)?;
    }
    Ok(with_numbers(volume, numbers))
}

/// One pass over all slices.
fn run(
    device: &mut Headless,
    dims: [u32; 3],
    numbers: &[f32],
    pass: &Pass,
) -> Result<Vec<f32>, Error> {
    let gpu = Arc::clone(device.gpu());
    let pipeline = ComputePipeline::new(&gpu, shader(&format!("denoise.{}", pass.kernel)))?;
    let slice = dims[0] as usize * dims[1] as usize;
    let slice_bytes = 4 * slice as u64;
    let halo = pass.radius;
    // At least one slice of its own in each slab; a device that has no room for it says so.
    let room = SLAB_BYTES.min(gpu.limits().max_storage_buffer_range.into());
    let own = (room / slice_bytes).saturating_sub(2 * u64::from(halo));
    let own = own.clamp(1, dims[2].into()) as u32;
    let bytes = slice_bytes * u64::from(own + 2 * halo);
    let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let before = Buffer::new(&gpu, bytes, storage, Memory::Upload, "noisy slices")?;
    let after = Buffer::new(&gpu, bytes, storage, Memory::Readback, "filtered slices")?;
    let ring = ParameterRing::new(&gpu, size_of::<Parameters>() as u32, 1, "noise filter")?;
    let given = [
        ("denoise", Resource::Uniform(&ring)),
        ("before", Resource::Storage(&before)),
        ("after", Resource::Storage(&after)),
    ];
    let bindings = Bindings::new(&gpu, pipeline.layout(), &given)?;

    let mut filtered = Vec::with_capacity(numbers.len());
    for first in (0..dims[2]).step_by(own as usize) {
        let count = own.min(dims[2] - first);
        let low = first.saturating_sub(halo);
        let high = (first + count + halo).min(dims[2]);
        let slices = slice * low as usize..slice * high as usize;
        before.write(0, bytemuck::cast_slice(&numbers[slices]))?;
        let slab = [dims[0], dims[1], high - low];
        let own = [dims[0], dims[1], count];
        for (origin, part) in parts(own, pass.fetches()) {
            let origin = [origin[0], origin[1], origin[2] + first - low];
            let parameters = parameters(pass, slab, origin, part);
            ring.write(0, bytemuck::bytes_of(&parameters))?;
            let (offset, groups) = (ring.offset(0)?, pipeline.groups(part)?);
            // SAFETY: recorded outside rendering; `run` waits, and all that is bound lives meanwhile.
            device.run(|cmd| unsafe {
                // Other dispatches have written other parts.
                buffer_barrier(&gpu, cmd, &after, Use::ComputeWrite, Use::ComputeWrite);
                pipeline.dispatch(cmd, &bindings, &[offset], groups);
                buffer_barrier(&gpu, cmd, &after, Use::ComputeWrite, Use::HostRead);
                Ok(())
            })?;
        }
        let start = filtered.len();
        filtered.resize(start + slice * count as usize, 0.0);
        let skipped = slice_bytes * u64::from(first - low);
        after.read(skipped, bytemuck::cast_slice_mut(&mut filtered[start..]))?;
    }
    Ok(filtered)
}

/// Slices of these dims in parts that are small enough: whole slices where those are, else rows of one.
fn parts(dims: [u32; 3], fetches: u64) -> Vec<([u32; 3], [u32; 3])> {
    let [width, height, depth] = dims;
    let row = u64::from(width) * fetches;
    let rows = (MAX_LOOKS / row).clamp(1, height.into()) as u32;
    let slices = match rows == height {
        true => (MAX_LOOKS / (row * u64::from(height))).clamp(1, depth.into()) as u32,
        false => 1,
    };
    let at = |z: u32| (0..height).step_by(rows as usize).map(move |y| [0, y, z]);
    let origins = (0..depth).step_by(slices as usize).flat_map(at);
    origins
        .map(|origin| {
            let [_, y, z] = origin;
            (origin, [width, rows.min(height - y), slices.min(depth - z)])
        })
        .collect()
}

fn parameters(pass: &Pass, dims: [u32; 3], origin: [u32; 3], part: [u32; 3]) -> Parameters {
    let weights = pass.weights.as_chunks::<4>().0;
    DenoiseFields {
        dims,
        origin,
        part,
        radius: pass.radius as i32,
        axis: pass.axis,
        difference_factor: pass.difference_factor,
        weights: std::array::from_fn(|i| weights[i]),
    }
    .into()
}
