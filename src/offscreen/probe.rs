//! What a device can do at most, measured: the ceiling that pictures are compared with.
//!
//! ```text
//! samples / s = threads * PROBE_SAMPLES / time     shaders/probe.wgsl: trilinear samples and nothing else
//! bytes / s   = 2 * bytes of a buffer / time       a copy reads each byte and writes it
//! ```
//!
//! A run is repeated inside one submission until it lasts, so that starting it does not count, and the shortest of
//! three submissions is taken: whatever else the machine does only makes them longer.

use super::{Error, upload::upload};
use crate::gpu::{
    self, Bindings, Buffer, ComputePipeline, Gpu, Headless, Memory, Resource, Timer, Use,
    buffer_barrier,
};
use crate::resident::TextureLayout;
use crate::shaders::{PROBE_SAMPLES, shader};
use crate::volume::Volume;
use ash::vk;
use std::sync::Arc;
use std::time::Instant;

/// What a device can do at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ceilings {
    /// Trilinear samples of the volume's own texture; `None` where the device cannot filter its format.
    pub samples_per_second: Option<f64>,
    /// Bytes read and bytes written, together.
    pub bytes_per_second: f64,
}

/// A submission lasts so long, where one run is shorter.
const LASTING_SECONDS: f64 = 0.02;
/// Samples of one run.
const LEAST_SAMPLES: u32 = 1 << 22;
/// Of a buffer: more than caches hold.
const COPIED_BYTES: u64 = 64 << 20;

/// Measures the device with the texture of `volume`.
///
/// # Errors
/// Those of the device.
pub fn ceilings(device: &mut Headless, volume: &Volume) -> Result<Ceilings, Error> {
    Ok(Ceilings {
        samples_per_second: samples_per_second(device, volume)?,
        bytes_per_second: bytes_per_second(device)?,
    })
}

fn samples_per_second(device: &mut Headless, volume: &Volume) -> Result<Option<f64>, Error> {
    let made = upload(device, &[volume], TextureLayout::Texture3d, None)?.swap_remove(0);
    if !made.texel().is_filtered {
        return Ok(None);
    }
    let gpu = Arc::clone(device.gpu());
    let brick = &made.bricks()[0];
    let [width, height, _] = brick.values.extent();
    let pipeline = ComputePipeline::new(&gpu, shader("probe"))?;
    let side = |count: u32| count.min(256).next_multiple_of(8);
    let (width, height) = (side(width), side(height));
    let depth = (LEAST_SAMPLES / PROBE_SAMPLES).div_ceil(width * height);
    // So deep that a real GPU is full.
    let depth = if gpu.is_cpu() { depth } else { 8 * depth };
    let threads = [width, height, depth];
    let count: u64 = threads.iter().map(|&n| u64::from(n)).product();
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let sums = Buffer::new(&gpu, 4 * count, usage, Memory::Device, "probe")?;
    let given = [
        ("probed", Resource::sampled(&brick.values)),
        ("probed_sampler", Resource::Sampler(made.sampler())),
        ("sums", Resource::Storage(&sums)),
    ];
    let bindings = Bindings::new(&gpu, pipeline.layout(), &given)?;
    let groups = pipeline.groups(threads)?;
    let seconds = shortest(device, |cmd, gpu| {
        // SAFETY: recorded outside rendering, the texture is in `Sampled`; all that is bound lives until `shortest`
        // has waited.
        unsafe {
            buffer_barrier(gpu, cmd, &sums, Use::ComputeWrite, Use::ComputeWrite);
            pipeline.dispatch(cmd, &bindings, &[], groups);
        }
    })?;
    Ok(Some(count as f64 * f64::from(PROBE_SAMPLES) / seconds))
}

fn bytes_per_second(device: &mut Headless) -> Result<f64, Error> {
    let gpu = Arc::clone(device.gpu());
    let bytes = COPIED_BYTES.min(gpu.limits().max_heap_bytes / 16);
    let buffer = |usage, name| Buffer::new(&gpu, bytes, usage, Memory::Device, name);
    let both = vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
    let from = buffer(both, "copied")?;
    let to = buffer(vk::BufferUsageFlags::TRANSFER_DST, "copy")?;
    // Memory that was never written may not be there yet.
    device.run(|cmd| {
        // SAFETY: recorded outside rendering into buffers of this usage, which live until `run` has waited.
        unsafe {
            gpu.record(|device| {
                device.cmd_fill_buffer(cmd, from.raw(), 0, vk::WHOLE_SIZE, 0x5a5a_a5a5)
            });
            buffer_barrier(&gpu, cmd, &from, Use::TransferWrite, Use::TransferRead);
        }
        Ok(())
    })?;
    let all = [vk::BufferCopy::default().size(bytes)];
    let seconds = shortest(device, |cmd, gpu| {
        // SAFETY: as above; both buffers hold so many bytes.
        unsafe {
            buffer_barrier(gpu, cmd, &to, Use::TransferWrite, Use::TransferWrite);
            gpu.record(|device| device.cmd_copy_buffer(cmd, from.raw(), to.raw(), &all));
        }
    })?;
    Ok(2.0 * bytes as f64 / seconds)
}

/// Seconds of one run of what `record` records.
fn shortest(
    device: &mut Headless,
    record: impl Fn(vk::CommandBuffer, &Gpu),
) -> Result<f64, gpu::Error> {
    let timer = Timer::new(device.gpu())?;
    let mut seconds_of = |times: u32| -> Result<f64, gpu::Error> {
        let gpu = Arc::clone(device.gpu());
        let start = Instant::now();
        device.run(|cmd| {
            // SAFETY: recorded outside rendering, in this order, into one command buffer that `run` waits for.
            let begin = || unsafe { timer.as_ref().inspect(|timer| timer.start(cmd)) };
            // SAFETY: as above.
            let end = || unsafe { timer.as_ref().inspect(|timer| timer.stop(cmd)) };
            begin();
            (0..times).for_each(|_| record(cmd, &gpu));
            end();
            Ok(())
        })?;
        let on_host = start.elapsed().as_secs_f64();
        let on_device = timer.as_ref().map_or(Ok(None), Timer::elapsed_ms)?;
        let on_device = on_device.map(|ms| 1e-3 * ms).filter(|&s| s > 0.0);
        Ok(on_device.unwrap_or(on_host) / f64::from(times))
    };
    // The first run makes what is made on first use.
    seconds_of(1)?;
    let times = (LASTING_SECONDS / seconds_of(1)?).ceil().clamp(1.0, 1000.0) as u32;
    let mut shortest = f64::INFINITY;
    for _ in 0..3 {
        shortest = shortest.min(seconds_of(times)?);
    }
    Ok(shortest)
}
