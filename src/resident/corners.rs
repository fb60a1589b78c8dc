//! The eight voxels around a sample in four words, for devices that compute on the CPU: their sampler is a program that
//! converts and weighs each texel by itself, and takes twice as long (`docs/performance.md`).
//!
//! ```text
//! of 8 bits:   word(w, y, z) = codes of (3 w, y, z), (3 w + 1, y, z), (3 w + 2, y, z), (3 w + 3, y, z), lowest byte first
//! of 16 bits:  word(w, y, z) = codes of (w, y, z), (w + 1, y, z), lower half first
//! ```
//!
//! So both ends of an edge along x are in one word: of 8 bits in 4/3 bytes a voxel, of 16 bits in 4. Beyond the edge of
//! the grid the outermost voxel stands. Words lie in cubes of 4 x 4 x 4, x fastest inside of one and from one to the next,
//! so that a ray finds what comes next in the same lines of the cache whichever way it runs; sides are rounded up to whole
//! cubes. They lie in a storage image: llvmpipe reads a storage buffer lane by lane, and looks up the mip levels of a
//! texture.

use super::{GpuVolume, TextureLayout};
use crate::gpu::{Error, Gpu, Image, ImageDesc, ImageKind, Use, image_barrier};
use crate::shaders::{CORNERS_WIDTH, VOXELS_A_WORD};
use crate::volume::{Volume, VoxelType, Voxels};
use ash::vk;
use std::num::NonZero;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

/// Words along the side of a cube.
pub(super) const SIDE: usize = 4;
pub(super) const CUBE_WORDS: usize = SIDE * SIDE * SIDE;
/// They take no more of the device's largest heap than one part of so many.
const SHARE: u64 = 4;
/// Shaders find the word of a voxel in a row of no more.
const MOST_VOXELS_A_ROW: u32 = 1 << 16;

/// How many words lie in a row of so many voxels.
fn words_a_row(stored: VoxelType, voxels: u32) -> Option<u32> {
    match stored {
        VoxelType::U8 | VoxelType::I8 => Some(voxels.div_ceil(VOXELS_A_WORD)),
        VoxelType::U16 | VoxelType::I16 => Some(voxels),
        _ => None,
    }
}

/// `words` are no more than a heap holds, or no image can be made of what comes out.
fn desc(words: u64) -> ImageDesc<'static> {
    let rows = words.div_ceil(u64::from(CORNERS_WIDTH));
    ImageDesc {
        kind: ImageKind::D2,
        extent: [CORNERS_WIDTH, rows.min(u64::from(u32::MAX)) as u32, 1],
        format: vk::Format::R32_UINT,
        usage: vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::TRANSFER_DST,
        name: "corners",
    }
}

/// The words of a volume of 8-bit or 16-bit integers, complete as soon as they are made.
#[derive(Debug)]
pub struct Corners {
    pub(super) image: Image,
    filter: &'static str,
    /// Voxels of a row from one word to the next.
    pub(super) new_voxels: u32,
}

impl Corners {
    /// Bytes that those of so many voxels take; `None` where there are none of this type.
    pub fn bytes_of(stored: VoxelType, [nx, ny, nz]: [u32; 3]) -> Option<u64> {
        let sides = [words_a_row(stored, nx)?, ny, nz];
        let cubes = sides.map(|n| u64::from(n.div_ceil(SIDE as u32)));
        let bytes = 4 * CUBE_WORDS as u64;
        Some(cubes.into_iter().fold(bytes, u64::saturating_mul))
    }

    /// Whether they pay and can be had: on a software device, of 8-bit or 16-bit integers in one brick, where that has
    /// such an image, in a quarter of its largest heap.
    pub fn are_for(gpu: &Gpu, volume: &Volume) -> bool {
        Self::are_for_such(gpu, volume.voxels.voxel_type(), volume.dims)
    }

    /// The same before there are voxels.
    pub(crate) fn are_for_such(gpu: &Gpu, stored: VoxelType, dims: [u32; 3]) -> bool {
        let Some(bytes) = Self::bytes_of(stored, dims) else {
            return false;
        };
        gpu.is_cpu()
            && bytes <= gpu.limits().max_heap_bytes / SHARE
            && dims[0] <= MOST_VOXELS_A_ROW
            && gpu.check_image(&desc(bytes / 4)).is_ok()
            && gpu.has_images_in_rows(&desc(bytes / 4))
    }

    /// Those of `volume`; none where the device leaves gaps between the rows of an image.
    ///
    /// # Errors
    /// Where the device gives no memory.
    ///
    /// # Panics
    /// Where [`Corners::are_for`] says no.
    pub fn new(gpu: &Arc<Gpu>, volume: &Volume) -> Result<Option<Self>, Error> {
        assert!(Self::are_for(gpu, volume), "corners of such a volume");
        match &volume.voxels {
            Voxels::U8(voxels) => Self::of_codes(gpu, volume.dims, voxels),
            Voxels::I8(voxels) => Self::of_codes(gpu, volume.dims, voxels),
            Voxels::U16(voxels) => Self::of_codes(gpu, volume.dims, voxels),
            Voxels::I16(voxels) => Self::of_codes(gpu, volume.dims, voxels),
            _ => unreachable!("asked above"),
        }
    }

    fn of_codes<C: Code>(
        gpu: &Arc<Gpu>,
        dims: [u32; 3],
        codes: &[C],
    ) -> Result<Option<Self>, Error> {
        let words = Self::bytes_of(C::STORED, dims).expect("codes have words") / 4;
        let [nx, ny, nz] = dims.map(|n| n as usize);
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
                let mut words = vec![0; layer_bytes / 4];
                while let Some((layer, out)) = next() {
                    let planes = layer * SIDE..nz.min((layer + 1) * SIDE);
                    let codes = &codes[planes.start * nx * ny..planes.end * nx * ny];
                    put_layer(codes, [nx, ny], &mut words);
                    out.copy_from_slice(bytemuck::cast_slice(&words));
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
        Ok(is_gapless.then_some(Self {
            image,
            filter: C::FILTER,
            new_voxels: C::VOXELS as u32 - 1,
        }))
    }

    /// A u32 for each word and what fills the cubes at the far ends, in rows of [`CORNERS_WIDTH`].
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// The word of shaders that read them.
    pub(crate) fn filter(&self) -> &'static str {
        self.filter
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

/// A number as it is stored, that has words. Signed ones are moved as texels are (`sampling.md` 2).
pub(super) trait Code: Copy + Sync {
    const STORED: VoxelType;
    const FILTER: &'static str;
    /// Of a word, the last of which the next one has too.
    const VOXELS: usize;
    fn word(voxels: &[Self]) -> u32;
}

impl Code for u8 {
    const STORED: VoxelType = VoxelType::U8;
    const FILTER: &'static str = "corners8";
    const VOXELS: usize = VOXELS_A_WORD as usize + 1;
    fn word(voxels: &[Self]) -> u32 {
        u32::from_le_bytes([voxels[0], voxels[1], voxels[2], voxels[3]])
    }
}

impl Code for i8 {
    const STORED: VoxelType = VoxelType::I8;
    const FILTER: &'static str = u8::FILTER;
    const VOXELS: usize = u8::VOXELS;
    fn word(voxels: &[Self]) -> u32 {
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| voxels[i] as u8);
        u32::from_le_bytes([a, b, c, d]) ^ 0x8080_8080
    }
}

impl Code for u16 {
    const STORED: VoxelType = VoxelType::U16;
    const FILTER: &'static str = "corners16";
    const VOXELS: usize = 2;
    fn word(voxels: &[Self]) -> u32 {
        u32::from(voxels[0]) | u32::from(voxels[1]) << 16
    }
}

impl Code for i16 {
    const STORED: VoxelType = VoxelType::I16;
    const FILTER: &'static str = u16::FILTER;
    const VOXELS: usize = u16::VOXELS;
    fn word(voxels: &[Self]) -> u32 {
        u16::word(&[voxels[0] as u16, voxels[1] as u16]) ^ 0x8000_8000
    }
}

/// Puts the words of at most four planes of nx x ny codes into a layer of cubes.
fn put_layer<C: Code>(codes: &[C], [nx, ny]: [usize; 2], cubes: &mut [u32]) {
    let along_x = nx.div_ceil(C::VOXELS - 1).div_ceil(SIDE);
    let mut longer = Vec::new();
    for (index, row) in codes.chunks_exact(nx).enumerate() {
        let [y, z] = [index % ny, index / ny];
        let cubes = &mut cubes[(y / SIDE) * along_x * CUBE_WORDS..];
        put_row(row, &mut longer, [y % SIDE, z], cubes);
    }
}

/// Puts the words of a row of codes into a row of cubes, at (y, z) of each. `row` is room that is used again.
pub(super) fn put_row<C: Code>(
    codes: &[C],
    row: &mut Vec<C>,
    [y, z]: [usize; 2],
    cubes: &mut [u32],
) {
    let new = C::VOXELS - 1;
    let words = codes.len().div_ceil(new);
    row.clear();
    row.extend_from_slice(codes);
    // Beyond the end the last voxel again.
    row.resize(new * words + 1, codes[codes.len() - 1]);
    let fours = cubes[SIDE * (y + SIDE * z)..].chunks_mut(CUBE_WORDS);
    let words = row.windows(C::VOXELS).step_by(new).map(C::word);
    put_in_fours(words, fours);
}

/// Each of the first four words into the first place, the next four into the next.
fn put_in_fours<'a>(
    mut words: impl Iterator<Item = u32>,
    places: impl Iterator<Item = &'a mut [u32]>,
) {
    for four in places {
        for place in four.iter_mut().take(SIDE) {
            let Some(word) = words.next() else {
                return;
            };
            *place = word;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shaders::{THIRD, THIRD_BITS};

    /// The words of one row.
    fn words_of<C: Code>(row: &[C]) -> Vec<u32> {
        let words = row.len().div_ceil(C::VOXELS - 1);
        let mut cubes = vec![0; words.div_ceil(SIDE) * CUBE_WORDS];
        put_layer(row, [row.len(), 1], &mut cubes);
        let word = |w: usize| cubes[w / SIDE * CUBE_WORDS + w % SIDE];
        (0..words).map(word).collect()
    }

    #[test]
    fn a_word_has_neighbours_of_a_row_and_at_the_edge_the_edge() {
        let bytes = |words: &[[u8; 4]]| -> Vec<_> {
            words.iter().map(|&word| u32::from_le_bytes(word)).collect()
        };
        assert_eq!(words_of(&[7_u8]), bytes(&[[7; 4]]));
        assert_eq!(words_of(&[1_u8, 2, 3]), bytes(&[[1, 2, 3, 3]]));
        let row = [1_u8, 2, 3, 4, 5];
        assert_eq!(words_of(&row), bytes(&[[1, 2, 3, 4], [4, 5, 5, 5]]));
        assert_eq!(words_of(&[-128_i8, 0, 127]), bytes(&[[0, 128, 255, 255]]));
        assert_eq!(words_of(&[1_u16, 2, 3]), [0x2_0001, 0x3_0002, 0x3_0003]);
        assert_eq!(words_of(&[i16::MIN, -1]), [0x7fff_0000, 0x7fff_7fff]);
    }

    #[test]
    fn a_word_lies_in_the_cube_of_its_place() {
        let [nx, ny, nz] = [6, 5, 3];
        let codes: Vec<u16> = (0..(nx * ny * nz) as u16).collect();
        let mut cubes = vec![0; 4 * CUBE_WORDS];
        put_layer(&codes, [nx, ny], &mut cubes);
        for (x, y, z) in [(0, 0, 0), (3, 3, 2), (4, 0, 1), (5, 4, 0), (2, 4, 2)] {
            let cube = x / 4 + 2 * (y / 4);
            let word = cubes[64 * cube + x % 4 + 4 * (y % 4) + 16 * z];
            assert_eq!(word as u16 as usize, x + nx * (y + ny * z));
        }
    }

    #[test]
    fn a_product_and_a_shift_are_a_third() {
        for voxel in 0..MOST_VOXELS_A_ROW {
            assert_eq!((voxel * THIRD) >> THIRD_BITS, voxel / VOXELS_A_WORD);
        }
    }

    #[test]
    fn bytes_are_those_of_whole_cubes() {
        let bytes = |stored, dims| Corners::bytes_of(stored, dims);
        assert_eq!(bytes(VoxelType::U8, [12, 4, 4]), Some(256));
        assert_eq!(bytes(VoxelType::I8, [13, 5, 4]), Some(4 * 256));
        assert_eq!(bytes(VoxelType::I16, [4, 4, 4]), Some(256));
        assert_eq!(bytes(VoxelType::U16, [5, 4, 9]), Some(6 * 256));
        assert_eq!(bytes(VoxelType::F16, [5, 4, 9]), None);
    }
}
