//! Eight voxels in two words, for devices that compute on the CPU: their sampler is a program that converts and weighs
//! each texel by itself, and takes twice as long (`docs/performance.md`).
//!
//! ```text
//! word(x, y, z) = codes of (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1) in plane z, lowest byte first
//! ```
//!
//! Beyond the edge the outermost voxel stands. Words lie in cubes of 4 x 4 x 4, x fastest inside of one and from one to
//! the next, so that a ray finds what comes next in the same lines of the cache whichever way it runs; sides are rounded
//! up to whole cubes. They lie in a storage image: llvmpipe reads a storage buffer lane by lane, and looks up the mip
//! levels of a texture. Four bytes a voxel, beside the texture.

use super::{GpuVolume, TextureLayout};
use crate::gpu::{Error, Gpu, Image, ImageDesc, ImageKind, Use, image_barrier};
use crate::shaders::CORNERS_WIDTH;
use crate::volume::{Volume, Voxels};
use ash::vk;
use std::num::NonZero;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

/// Voxels along the side of a cube.
const SIDE: usize = 4;
const CUBE_WORDS: usize = SIDE * SIDE * SIDE;
/// 128 MiB. To make more takes longer than a few pictures win.
const MOST_WORDS: u64 = 1 << 25;

fn words_in_cubes(dims: [u32; 3]) -> u64 {
    let cubes = dims.map(|n| u64::from(n.div_ceil(SIDE as u32)));
    cubes
        .into_iter()
        .fold(CUBE_WORDS as u64, u64::saturating_mul)
}

/// `words` is at most [`MOST_WORDS`], or no image can be made of what comes out.
fn desc(words: u64) -> ImageDesc<'static> {
    let rows = words.div_ceil(u64::from(CORNERS_WIDTH));
    ImageDesc {
        kind: ImageKind::D2,
        extent: [CORNERS_WIDTH, rows.min(u64::from(u32::MAX)) as u32, 1],
        format: vk::Format::R32_UINT,
        usage: vk::ImageUsageFlags::STORAGE,
        name: "corners",
    }
}

/// The words of a volume of 8-bit integers, complete as soon as they are made.
#[derive(Debug)]
pub struct Corners {
    image: Image,
}

impl Corners {
    /// Bytes that those of so many voxels take; 0 where these are too many.
    pub fn bytes_of(dims: [u32; 3]) -> u64 {
        match words_in_cubes(dims) {
            words if words <= MOST_WORDS => 4 * words,
            _ => 0,
        }
    }

    /// Whether they pay and can be had: on a software device, of 8-bit integers in one brick, where that has such an
    /// image.
    pub fn are_for(gpu: &Gpu, volume: &Volume) -> bool {
        let is_byte = matches!(volume.voxels, Voxels::U8(_) | Voxels::I8(_));
        let words = words_in_cubes(volume.dims);
        gpu.is_cpu()
            && is_byte
            && words <= MOST_WORDS
            && gpu.check_image(&desc(words)).is_ok()
            && gpu.has_images_in_rows(&desc(words))
    }

    /// Those of `volume`; none where the device leaves gaps between the rows of an image.
    ///
    /// # Errors
    /// Where the device gives no memory.
    ///
    /// # Panics
    /// Where [`Corners::are_for`] says no.
    pub fn new(gpu: &Arc<Gpu>, volume: &Volume) -> Result<Option<Self>, Error> {
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
        let words = words_in_cubes(volume.dims);
        // Most of the time goes into the first touch of so much memory, which threads share.
        let layers = nz.div_ceil(SIDE);
        let layer_bytes = 4 * words as usize / layers;
        let mut is_gapless = false;
        let image = Image::written_by_host(gpu, &desc(words), |bytes, row_bytes| {
            is_gapless = row_bytes == 4 * CORNERS_WIDTH as usize;
            if !is_gapless {
                return;
            }
            let bytes = &mut bytes[..layers * layer_bytes];
            let layers_left = Mutex::new(bytes.chunks_exact_mut(layer_bytes).enumerate());
            let next = || {
                layers_left
                    .lock()
                    .unwrap_or_else(PoisonError::into_inner)
                    .next()
            };
            let work = || {
                while let Some((layer, out)) = next() {
                    let planes = (layer * SIDE..nz.min((layer + 1) * SIDE))
                        .map(|z| words_of(&codes(z * nx * ny..(z + 1) * nx * ny), nx));
                    out.copy_from_slice(bytemuck::cast_slice(&cubes_of(planes, nx, ny)));
                }
            };
            let threads = thread::available_parallelism().map_or(1, NonZero::get);
            thread::scope(|scope| {
                for _ in 1..threads.min(layers) {
                    scope.spawn(work);
                }
                work();
            });
        })?;
        Ok(is_gapless.then_some(Self { image }))
    }

    /// A u32 for each voxel and what fills the cubes at the far ends, in rows of [`CORNERS_WIDTH`].
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// Records what makes them readable.
    ///
    /// # Safety
    /// `cmd` is recording on their device, outside rendering; they live until it has run. Once is enough.
    pub unsafe fn record_upload(&self, gpu: &Gpu, cmd: vk::CommandBuffer) {
        // SAFETY: the caller's promises; the host has written all texels.
        unsafe { image_barrier(gpu, cmd, &self.image, Use::HostWrite, Use::ComputeRead) };
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

/// Puts the words of at most four planes of nx x ny into a layer of cubes.
fn cubes_of(planes: impl Iterator<Item = Vec<u32>>, nx: usize, ny: usize) -> Vec<u32> {
    let along_x = nx.div_ceil(SIDE);
    let mut cubes = vec![0; along_x * ny.div_ceil(SIDE) * CUBE_WORDS];
    for (z, plane) in planes.enumerate() {
        for (y, row) in plane.chunks_exact(nx).enumerate() {
            let first = (y / SIDE) * along_x * CUBE_WORDS + SIDE * (y % SIDE + SIDE * z);
            for (x, words) in row.chunks(SIDE).enumerate() {
                let first = first + x * CUBE_WORDS;
                cubes[first..first + words.len()].copy_from_slice(words);
            }
        }
    }
    cubes
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

    #[test]
    fn a_word_lies_in_the_cube_of_its_voxel() {
        let [nx, ny] = [6, 5];
        let planes = (0..3).map(|z| (0..30).map(|i| 100 * z + i).collect());
        let cubes = cubes_of(planes, nx, ny);
        assert_eq!(cubes.len(), 4 * 64);
        for (x, y, z) in [(0, 0, 0), (3, 3, 2), (4, 0, 1), (5, 4, 0), (2, 4, 2)] {
            let cube = x / 4 + 2 * (y / 4);
            let word = cubes[64 * cube + x % 4 + 4 * (y % 4) + 16 * z];
            assert_eq!(word as usize, 100 * z + x + nx * y);
        }
    }
}
