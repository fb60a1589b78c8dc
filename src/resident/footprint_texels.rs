//! The eight voxels around a sample in two texels or four, for devices that compute on the CPU: their sampler is a
//! program that converts and weighs each voxel by itself, and takes twice as long (`docs/log/performance.md`).
//!
//! ```text
//! of 8 bits:   texel(i, j, z) = codes of (3 i .. 3 i + 3, 3 j .. 3 j + 3, z), a row in each of four words
//! of 16 bits:  texel(i, j, z) = codes of (i .. i + 1, j, z), in one word
//! ```
//!
//! So the four corners of a face between voxel centres are in one texel of 8 bits, 16/9 bytes a voxel; of 16 bits that
//! would be 16/3, and both ends of an edge along x are in one texel, 4 bytes a voxel. x first, lowest bits first;
//! beyond the edge of the grid the outermost voxel stands. Texels lie in cubes of 4 x 4 x 4, z fastest inside of one,
//! then x, so that a line of the cache is as deep as it is wide; from one cube to the next x is fastest, and sides are
//! rounded up to whole cubes. They lie in a storage image: llvmpipe reads a storage buffer lane by lane, looks up the
//! mip levels of a texture, and loads a texel of 16 bytes at once, where four gathers take longer.

use super::{GpuVolume, TextureLayout};
use crate::gpu::{Error, Gpu, Image, ImageDesc, ImageKind, Use, image_barrier};
use crate::shaders::CORNERS_WIDTH;
use crate::volume::{Volume, VoxelType, Voxels};
use ash::vk;
use std::num::NonZero;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

/// Texels along the side of a cube.
pub(super) const SIDE: usize = 4;
pub(super) const CUBE_TEXELS: usize = SIDE * SIDE * SIDE;
/// They take no more of the device's largest heap than one part of so many.
const SHARE: u64 = 4;
/// Shaders find the texel of a voxel in a row of no more, along x and y.
const MOST_VOXELS_A_ROW: u32 = 1 << 16;

/// What one texel holds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Texel {
    /// Words of it.
    pub words: usize,
    /// Voxels from one to the next along each axis.
    pub new_voxels: [u32; 3],
}

impl Texel {
    fn of(stored: VoxelType) -> Option<Self> {
        match stored {
            VoxelType::U8 | VoxelType::I8 => Some(u8::TEXEL),
            VoxelType::U16 | VoxelType::I16 => Some(u16::TEXEL),
            _ => None,
        }
    }

    pub fn bytes(self) -> u64 {
        4 * self.words as u64
    }

    pub fn cube_words(self) -> usize {
        self.words * CUBE_TEXELS
    }

    /// No more texels than a heap holds, or no image can be made of what comes out.
    fn image(self, bytes: u64) -> ImageDesc<'static> {
        let rows = (bytes / self.bytes()).div_ceil(u64::from(CORNERS_WIDTH));
        ImageDesc {
            kind: ImageKind::D2,
            extent: [CORNERS_WIDTH, rows.min(u64::from(u32::MAX)) as u32, 1],
            format: match self.words {
                1 => vk::Format::R32_UINT,
                _ => vk::Format::R32G32B32A32_UINT,
            },
            usage: vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::TRANSFER_DST,
            name: "corners",
        }
    }
}

/// The texels of a volume of 8-bit or 16-bit integers, complete as soon as they are made.
#[derive(Debug)]
pub struct FootprintTexels {
    pub(super) image: Image,
    filter: &'static str,
    pub(super) texel: Texel,
}

impl FootprintTexels {
    /// Bytes that those of so many voxels take; `None` where there are none of this type.
    pub fn bytes_of(stored: VoxelType, dims: [u32; 3]) -> Option<u64> {
        let texel = Texel::of(stored)?;
        let new = texel.new_voxels;
        let cubes = [0, 1, 2].map(|k| u64::from(dims[k].div_ceil(new[k]).div_ceil(SIDE as u32)));
        let bytes = texel.bytes() * CUBE_TEXELS as u64;
        Some(cubes.into_iter().fold(bytes, u64::saturating_mul))
    }

    /// Whether they pay and can be had: on a software device, of 8-bit or 16-bit integers in one brick, where that has
    /// such an image, in a quarter of its largest heap.
    pub fn are_for(gpu: &Gpu, volume: &Volume) -> bool {
        Self::are_for_such(gpu, volume.voxels.voxel_type(), volume.dims)
    }

    /// The same before there are voxels.
    pub(crate) fn are_for_such(gpu: &Gpu, stored: VoxelType, dims: [u32; 3]) -> bool {
        let Some((bytes, texel)) = Self::bytes_of(stored, dims).zip(Texel::of(stored)) else {
            return false;
        };
        gpu.is_cpu()
            && bytes <= gpu.limits().max_heap_bytes / SHARE
            && dims[0].max(dims[1]) <= MOST_VOXELS_A_ROW
            && gpu.check_image(&texel.image(bytes)).is_ok()
            && gpu.has_images_in_rows(&texel.image(bytes))
    }

    /// Those of `volume`; none where the device leaves gaps between the rows of an image.
    ///
    /// # Errors
    /// Where the device gives no memory.
    ///
    /// # Panics
    /// Where [`FootprintTexels::are_for`] says no.
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
        let bytes = Self::bytes_of(C::STORED, dims).expect("codes have texels");
        let desc = C::TEXEL.image(bytes);
        let [nx, ny, nz] = dims.map(|n| n as usize);
        // Most of the time goes into the first touch of so much memory, which threads share.
        let layers = nz.div_ceil(SIDE);
        let layer_bytes = bytes as usize / layers;
        let mut is_gapless = false;
        let image = Image::written_by_host(gpu, &desc, |bytes, row_bytes| {
            is_gapless = row_bytes as u64 == C::TEXEL.bytes() * u64::from(CORNERS_WIDTH);
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
            texel: C::TEXEL,
        }))
    }

    /// The texels and what fills the cubes at the far ends, in rows of [`CORNERS_WIDTH`].
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
        unsafe { image_barrier(gpu, cmd, &self.image, Use::HostWrite, Use::SampledOrRead) };
    }
}

impl GpuVolume {
    /// Puts the corners of the same voxels beside the texture, for linear filters.
    ///
    /// # Panics
    /// Where the volume lies in several bricks or in stacks, or holds coefficients.
    pub fn keep_corners(&mut self, corners: FootprintTexels) {
        let is_box = self.layout() == TextureLayout::Texture3d && self.bricks().len() == 1;
        assert!(
            is_box && self.spline().is_none(),
            "corners of one box of voxels"
        );
        self.corners = Some(corners);
    }

    /// Its corners, where it has them.
    pub fn corners(&self) -> Option<&FootprintTexels> {
        self.corners.as_ref()
    }
}

/// A number as it is stored, that has texels. Signed ones are moved as texels of a texture are (`sampling.md` 2).
pub(super) trait Code: Copy + Sync {
    const STORED: VoxelType;
    const FILTER: &'static str;
    const TEXEL: Texel;
    /// A word holds neighbours of a row, the last of which the next texel has too.
    fn word(neighbours: &[Self]) -> u32;
}

impl Code for u8 {
    const STORED: VoxelType = VoxelType::U8;
    const FILTER: &'static str = "footprint8";
    const TEXEL: Texel = Texel {
        words: 4,
        new_voxels: [3, 3, 1],
    };
    fn word(four: &[Self]) -> u32 {
        u32::from_le_bytes([four[0], four[1], four[2], four[3]])
    }
}

impl Code for i8 {
    const STORED: VoxelType = VoxelType::I8;
    const FILTER: &'static str = u8::FILTER;
    const TEXEL: Texel = u8::TEXEL;
    fn word(four: &[Self]) -> u32 {
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| four[i] as u8);
        u32::from_le_bytes([a, b, c, d]) ^ 0x8080_8080
    }
}

impl Code for u16 {
    const STORED: VoxelType = VoxelType::U16;
    const FILTER: &'static str = "footprint16";
    const TEXEL: Texel = Texel {
        words: 1,
        new_voxels: [1, 1, 1],
    };
    fn word(two: &[Self]) -> u32 {
        u32::from(two[0]) | u32::from(two[1]) << 16
    }
}

impl Code for i16 {
    const STORED: VoxelType = VoxelType::I16;
    const FILTER: &'static str = u16::FILTER;
    const TEXEL: Texel = u16::TEXEL;
    fn word(two: &[Self]) -> u32 {
        u16::word(&[two[0] as u16, two[1] as u16]) ^ 0x8000_8000
    }
}

/// Puts at most four planes of nx x ny codes into a layer of cubes.
fn put_layer<C: Code>(codes: &[C], [nx, ny]: [usize; 2], cubes: &mut [u32]) {
    let mut longer = Vec::new();
    for (index, row) in codes.chunks_exact(nx).enumerate() {
        let place = RowPlace {
            y: index % ny,
            z: index / ny,
            is_last: index % ny == ny - 1,
            cubes: nx.div_ceil(C::TEXEL.new_voxels[0] as usize).div_ceil(SIDE),
        };
        put_row(row, &mut longer, place, cubes);
    }
}

/// Where a row of voxels lies in a layer of cubes.
#[derive(Clone, Copy, Debug)]
pub(super) struct RowPlace {
    pub y: usize,
    /// In its cube.
    pub z: usize,
    /// The outermost one stands beyond the edge too.
    pub is_last: bool,
    /// In a row of them.
    pub cubes: usize,
}

/// Puts a row of codes into those of a layer's `cubes` that have some of it. `longer` is room that is used again.
pub(super) fn put_row<C: Code>(
    codes: &[C],
    longer: &mut Vec<C>,
    place: RowPlace,
    cubes: &mut [u32],
) {
    let Texel { words, new_voxels } = C::TEXEL;
    let [columns, rows, _] = new_voxels.map(|new| new as usize);
    let texels = codes.len().div_ceil(columns);
    longer.clear();
    longer.extend_from_slice(codes);
    longer.resize(columns * texels + 1, codes[codes.len() - 1]);
    let RowPlace { y, z, is_last, .. } = place;
    // As one of the rows of a texel, and where it is the first and others have it too as the last of the texel before.
    let [texel, row] = [y / rows, y % rows];
    let before = (words > 1 && row == 0 && texel > 0).then(|| (texel - 1, rows..=rows));
    let until = if is_last { words - 1 } else { row };
    for (texel, rows) in before.into_iter().chain([(texel, row..=until)]) {
        // Beside the cubes that are asked for there may be others, which share some of these voxels.
        let mut rows_of_cubes = cubes.chunks_exact_mut(C::TEXEL.cube_words() * place.cubes);
        let Some(cubes) = rows_of_cubes.nth(texel / SIDE) else {
            continue;
        };
        let first = z + SIDE * SIDE * (texel % SIDE);
        for row in rows {
            let neighbours = longer.windows(columns + 1).step_by(columns);
            for (column, neighbours) in neighbours.take(SIDE * place.cubes).enumerate() {
                let at = first + CUBE_TEXELS * (column / SIDE) + SIDE * (column % SIDE);
                cubes[words * at + row] = C::word(neighbours);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shaders::{THIRD, THIRD_BITS};

    /// The texels of planes of nx x ny codes, and the words of the one at (i, j, z).
    fn texels_of<C: Code>(codes: &[C], [nx, ny]: [usize; 2]) -> impl Fn([usize; 3]) -> Vec<u32> {
        let Texel { words, new_voxels } = C::TEXEL;
        let along = |k: usize, n: usize| n.div_ceil(new_voxels[k] as usize).div_ceil(SIDE);
        let [along_x, along_y] = [along(0, nx), along(1, ny)];
        let mut cubes = vec![0; along_x * along_y * C::TEXEL.cube_words()];
        put_layer(codes, [nx, ny], &mut cubes);
        move |[i, j, z]| {
            let cube = i / SIDE + along_x * (j / SIDE);
            let texel = CUBE_TEXELS * cube + z + SIDE * (i % SIDE + SIDE * (j % SIDE));
            cubes[words * texel..words * (texel + 1)].to_vec()
        }
    }

    #[test]
    fn a_texel_has_neighbours_of_a_plane_and_at_the_edge_the_edge() {
        let rows = |rows: [[u8; 4]; 4]| rows.map(u32::from_le_bytes);
        assert_eq!(texels_of(&[7_u8], [1, 1])([0; 3]), rows([[7; 4]; 4]));
        let codes: Vec<u8> = (0..20).collect();
        let texel = texels_of(&codes, [5, 4]);
        let first = [0, 5, 10, 15].map(|k| [k, k + 1, k + 2, k + 3]);
        assert_eq!(texel([0, 0, 0]), rows(first));
        assert_eq!(texel([1, 1, 0]), rows([[18, 19, 19, 19]; 4]));
        let signed = texels_of(&[-128_i8, 0, 127], [3, 1]);
        assert_eq!(signed([0; 3]), rows([[0, 128, 255, 255]; 4]));
        let wide = texels_of(&[1_u16, 2, 3, 4, 5, 6], [3, 2]);
        assert_eq!(wide([0; 3]), [0x2_0001]);
        assert_eq!(wide([2, 1, 0]), [0x6_0006]);
        let signed = texels_of(&[i16::MIN, -1], [2, 1]);
        assert_eq!(
            [signed([0; 3]), signed([1, 0, 0])],
            [[0x7fff_0000], [0x7fff_7fff]]
        );
    }

    #[test]
    fn each_texel_lies_in_the_cube_of_its_place() {
        let [nx, ny, nz] = [16, 14, 3];
        let code = |x: usize, y: usize, z: usize| (x + nx * (y + ny * z)) as u16;
        let codes: Vec<u16> = (0..code(0, 0, nz)).collect();
        let bytes: Vec<u8> = codes.iter().map(|&code| code as u8).collect();
        let wide = texels_of(&codes, [nx, ny]);
        let narrow = texels_of(&bytes, [nx, ny]);
        for (i, j, z) in [(0, 0, 0), (3, 3, 2), (4, 0, 1), (5, 4, 0), (2, 4, 2)] {
            assert_eq!(wide([i, j, z])[0] as u16, code(i, j, z));
            assert_eq!(narrow([i, j, z])[0] as u8, code(3 * i, 3 * j, z) as u8);
        }
    }

    #[test]
    fn a_product_and_a_shift_are_a_third() {
        for voxel in 0..MOST_VOXELS_A_ROW {
            assert_eq!(
                (voxel * THIRD) >> THIRD_BITS,
                voxel / u8::TEXEL.new_voxels[0]
            );
        }
    }

    #[test]
    fn bytes_are_those_of_whole_cubes() {
        let bytes = |stored, dims| FootprintTexels::bytes_of(stored, dims);
        assert_eq!(bytes(VoxelType::U8, [12, 12, 4]), Some(1024));
        assert_eq!(bytes(VoxelType::I8, [13, 13, 4]), Some(4 * 1024));
        assert_eq!(bytes(VoxelType::I16, [4, 4, 4]), Some(256));
        assert_eq!(bytes(VoxelType::U16, [5, 4, 9]), Some(6 * 256));
        assert_eq!(bytes(VoxelType::F16, [5, 4, 9]), None);
    }
}
