//! Eight voxels in two words, for devices that compute on the CPU: their sampler is a program that converts and weighs
//! each texel by itself, and takes twice as long (`docs/performance.md`).
//!
//! ```text
//! word(x, y, z) = codes of (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1) in plane z, lowest byte first
//! ```
//!
//! Beyond the edge the outermost voxel stands. Four bytes a voxel, beside the texture.

use super::{GpuVolume, TextureLayout};
use crate::gpu::{Buffer, Error, Gpu, Memory};
use crate::volume::{Volume, Voxels};
use ash::vk;
use std::num::NonZero;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

/// The words of a volume of 8-bit integers, complete as soon as they are made.
#[derive(Debug)]
pub struct Corners {
    buffer: Buffer,
}

impl Corners {
    /// Bytes of one voxel.
    pub const BYTES_PER_VOXEL: u64 = 4;

    /// Whether they pay and can be had: on a software device, of 8-bit integers in one brick, where a buffer may be so
    /// long.
    pub fn are_for(gpu: &Gpu, volume: &Volume) -> bool {
        let voxels: u64 = volume.dims.iter().map(|&n| u64::from(n)).product();
        let is_byte = matches!(volume.voxels, Voxels::U8(_) | Voxels::I8(_));
        let limit = u64::from(gpu.limits().max_storage_buffer_range);
        gpu.is_cpu() && is_byte && voxels.saturating_mul(Self::BYTES_PER_VOXEL) <= limit
    }

    /// Those of `volume`.
    ///
    /// # Errors
    /// Where the device gives no memory.
    ///
    /// # Panics
    /// Where [`Corners::are_for`] says no.
    pub fn new(gpu: &Arc<Gpu>, volume: &Volume) -> Result<Self, Error> {
        assert!(Self::are_for(gpu, volume), "corners of 8-bit integers");
        let codes = |row: std::ops::Range<usize>| -> Vec<u8> {
            match &volume.voxels {
                Voxels::U8(voxels) => voxels[row].to_vec(),
                // As the texels: moved, not SNORM.
                Voxels::I8(voxels) => voxels[row].iter().map(|&v| v as u8 ^ 0x80).collect(),
                _ => unreachable!("checked above"),
            }
        };
        let [nx, ny, nz] = volume.dims.map(|n| n as usize);
        let bytes = (nx * ny * nz) as u64 * Self::BYTES_PER_VOXEL;
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let buffer = Buffer::new(gpu, bytes, usage, Memory::Upload, "corners")?;
        // Most of the time goes into the first touch of so much memory, which threads share.
        let plane_bytes = nx * ny * Self::BYTES_PER_VOXEL as usize;
        buffer.write_with(0, bytes, |words| {
            let planes = Mutex::new(words.chunks_exact_mut(plane_bytes).enumerate());
            let next = || planes.lock().unwrap_or_else(PoisonError::into_inner).next();
            let work = || {
                while let Some((z, out)) = next() {
                    let plane = codes(z * nx * ny..(z + 1) * nx * ny);
                    out.copy_from_slice(bytemuck::cast_slice(&words_of(&plane, nx)));
                }
            };
            let threads = thread::available_parallelism().map_or(1, NonZero::get);
            thread::scope(|scope| {
                for _ in 1..threads.min(nz) {
                    scope.spawn(work);
                }
                work();
            });
        })?;
        Ok(Self { buffer })
    }

    /// A u32 for each voxel, x fastest.
    pub fn buffer(&self) -> &Buffer {
        &self.buffer
    }
}

impl GpuVolume {
    /// Puts the corners of the same voxels beside the texture, for linear filters.
    ///
    /// # Panics
    /// Where the volume lies in several bricks or in stacks, or holds coefficients.
    pub fn keep_corners(&mut self, corners: Corners) {
        let is_box = self.layout() == TextureLayout::Texture3d && self.bricks().len() == 1;
        assert!(
            is_box && self.spline().is_none(),
            "corners of one box of voxels"
        );
        self.corners = Some(corners);
    }

    /// Its corners, where it has them.
    pub fn corners(&self) -> Option<&Corners> {
        self.corners.as_ref()
    }
}

/// The words of one plane with rows of `nx` codes.
fn words_of(plane: &[u8], nx: usize) -> Vec<u32> {
    let mut words = Vec::with_capacity(plane.len());
    let mut rows = plane.chunks_exact(nx).peekable();
    while let Some(row) = rows.next() {
        let next = rows.peek().copied().unwrap_or(row);
        let pairs = row.windows(2).zip(next.windows(2));
        words.extend(pairs.map(|(a, b)| u32::from_le_bytes([a[0], a[1], b[0], b[1]])));
        let (a, b) = (row[nx - 1], next[nx - 1]);
        words.push(u32::from_le_bytes([a, a, b, b]));
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_has_four_neighbours_and_at_the_edge_the_edge() {
        let words = words_of(&[1, 2, 3, 4, 5, 6], 3);
        let expected = [
            [1, 2, 4, 5],
            [2, 3, 5, 6],
            [3, 3, 6, 6],
            [4, 5, 4, 5],
            [5, 6, 5, 6],
            [6, 6, 6, 6],
        ];
        assert_eq!(words, expected.map(u32::from_le_bytes));
        assert_eq!(words_of(&[7], 1), [u32::from_le_bytes([7; 4])]);
    }
}
