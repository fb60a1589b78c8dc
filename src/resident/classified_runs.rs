//! Classified voxels on the device as runs: of each row of voxels along x those alone whose optical depth is over 0.
//!
//! ```text
//! words      of each 32 voxels of a row a mask, and how many full voxels come before          8 bytes
//! payload    of full voxels in their order (red, green, blue times depth, depth)              8 bytes, or 16
//! ```
//!
//! Lacroute and Levoy, "Fast Volume Rendering Using a Shear-Warp Factorization of the Viewing Transformation", SIGGRAPH
//! 1994, keep theirs for each of the three axes; with ranks one encoding serves all of them.

use crate::gpu::{Buffer, Error, Gpu, Headless, Memory, Use, buffer_barrier, buffer_to_buffer};
use crate::volume::{Rescale, RunBits, Volume, Voxels};
use ash::vk;
use half::f16;
use std::sync::Arc;

/// What is staged at once: a multiple of a payload.
const STAGING_BYTES: u64 = 4 << 20;

/// The floats of a payload.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PayloadFloats {
    /// Of 16 bits: off by 2^-11 of each number, and by 2^-25 below 2^-14.
    Half,
    /// Of 32 bits, as volumes hold them.
    Single,
}

/// What runs of classified voxels take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunsSize {
    /// Voxels whose optical depth is over 0.
    pub full: u64,
    /// Longest sequences of them in rows along x.
    pub runs: u64,
    /// Bytes of words and payload on the device.
    pub bytes: u64,
}

/// The runs of four volumes as `technique::preclassified` makes them: red, green and blue times depth, and depth. In the
/// device's own memory.
#[derive(Debug)]
pub struct ClassifiedRuns {
    buffer: Buffer,
    size: RunsSize,
}

impl PayloadFloats {
    /// Bytes of the four numbers of a voxel.
    fn bytes(self) -> usize {
        match self {
            Self::Half => 4 * size_of::<f16>(),
            Self::Single => 4 * size_of::<f32>(),
        }
    }

    fn encode(self, numbers: [f32; 4], bytes: &mut [u8]) {
        match self {
            Self::Half => {
                let halves = numbers.map(|n| f16::from_f32(n).to_bits());
                bytes.copy_from_slice(bytemuck::bytes_of(&halves));
            }
            Self::Single => bytes.copy_from_slice(bytemuck::bytes_of(&numbers)),
        }
    }

    /// Whether the numbers of a volume can be such floats.
    fn hold(self, volume: &Volume) -> bool {
        self == Self::Single || volume.value_range[1] <= f64::from(f16::MAX)
    }
}

/// The numbers of four volumes of plain floats on one grid; `None` of others, and where such floats cannot hold them.
fn numbers_of(volumes: [&Volume; 4], floats: PayloadFloats) -> Option<[&[f32]; 4]> {
    let grid = volumes[0].grid();
    let plain = volumes.map(|volume| match &volume.voxels {
        Voxels::F32(numbers)
            if volume.rescale == Rescale::default()
                && volume.grid() == grid
                && floats.hold(volume) =>
        {
            Some(&numbers[..])
        }
        _ => None,
    });
    match plain {
        [Some(red), Some(green), Some(blue), Some(depth)] => Some([red, green, blue, depth]),
        _ => None,
    }
}

impl ClassifiedRuns {
    /// The runs of four volumes: red, green and blue times depth, and depth; `None` where they are not floats without a rescale
    /// on one grid, or have numbers larger than such floats can be.
    ///
    /// # Errors
    /// Where the device gives no memory, or has no buffers of that size.
    pub fn new(
        device: &mut Headless,
        volumes: [&Volume; 4],
        floats: PayloadFloats,
    ) -> Result<Option<Self>, Error> {
        let Some(numbers) = numbers_of(volumes, floats) else {
            return Ok(None);
        };
        let validity = volumes[3].validity.as_deref();
        let is_full = |n: usize| numbers[3][n] > 0.0 && validity.is_none_or(|valid| valid[n] != 0);
        let bits = RunBits::of_rows(volumes[3].dims, is_full);
        let words: &[u8] = bytemuck::cast_slice(bits.words());
        let payload_bytes = bits.full_count() * floats.bytes() as u64;
        let bytes = words.len() as u64 + payload_bytes;
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
        let buffer = Buffer::new(device.gpu(), bytes, usage, Memory::Device, "runs")?;
        fill(device, &buffer, 0, words.len() as u64, |from, out| {
            out.copy_from_slice(&words[from..from + out.len()]);
        })?;
        let mut full = bits.voxels();
        fill(
            device,
            &buffer,
            words.len() as u64,
            payload_bytes,
            |_, out| {
                for (out, n) in out.chunks_exact_mut(floats.bytes()).zip(&mut full) {
                    floats.encode(numbers.map(|of| of[n]), out);
                }
            },
        )?;
        let gpu = Arc::clone(device.gpu());
        device.run(|cmd| {
            // SAFETY: the buffer lives until `run` has waited, and nothing else knows it yet.
            unsafe { buffer_barrier(&gpu, cmd, &buffer, Use::TransferWrite, Use::ComputeRead) };
            Ok::<(), Error>(())
        })?;
        Ok(Some(Self {
            size: RunsSize {
                full: bits.full_count(),
                runs: bits.run_count(),
                bytes,
            },
            buffer,
        }))
    }

    /// What they take.
    pub fn size(&self) -> RunsSize {
        self.size
    }

    /// Words, and behind them the payload (`shaders/lib/channels_on_runs.wgsl`).
    pub(crate) fn buffer(&self) -> &Buffer {
        &self.buffer
    }
}

/// Fills `bytes` of a buffer from `first` on, in parts: `write` gets how many bytes come before a part, and its place.
fn fill(
    device: &mut Headless,
    buffer: &Buffer,
    first: u64,
    bytes: u64,
    mut write: impl FnMut(usize, &mut [u8]),
) -> Result<(), Error> {
    if bytes == 0 {
        return Ok(());
    }
    let gpu: Arc<Gpu> = Arc::clone(device.gpu());
    let usage = vk::BufferUsageFlags::TRANSFER_SRC;
    let size = bytes.min(STAGING_BYTES);
    let staging = Buffer::new(&gpu, size, usage, Memory::Upload, "staging of runs")?;
    for from in (0..bytes).step_by(STAGING_BYTES as usize) {
        let count = STAGING_BYTES.min(bytes - from);
        staging.write_with(0, count, |out| write(from as usize, out))?;
        let part = vk::BufferCopy::default()
            .dst_offset(first + from)
            .size(count);
        device.run(|cmd| {
            // SAFETY: recorded outside rendering; both live until `run` has waited, nothing else knows them yet, and the host has
            // written this part before.
            unsafe { buffer_to_buffer(&gpu, cmd, &staging, buffer, &[part]) }
        })?;
    }
    Ok(())
}
