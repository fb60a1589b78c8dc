//! Footprint texels after voxels of a box have changed: the cubes of texels that have some of them, and no others.

use super::FootprintTexels;
use super::footprint_texels::{CUBE_TEXELS, Code, RowPlace, SIDE, put_row};
use crate::gpu::{Buffer, Error, Gpu, Region, Use, buffer_to_image, image_barrier};
use crate::shaders::CORNERS_WIDTH;
use crate::volume::{VoxelBox, VoxelPart, Voxels};
use ash::vk;
use std::ops::Range;

/// Words that change with voxels of a box.
#[derive(Debug, Default)]
pub(crate) struct ChangedCorners {
    /// Those of one row of cubes after those of another.
    pub words: Vec<u32>,
    /// Where they go, in their order.
    copies: Vec<Region>,
    texel_bytes: u64,
}

impl FootprintTexels {
    /// Voxels from one cube to the next.
    fn sides(&self) -> [u32; 3] {
        self.texel.new_voxels.map(|new| new * SIDE as u32)
    }

    /// The cubes, along each axis, that have texels of voxels of `region`, and the voxels that those are made of.
    fn cubes_of(&self, region: VoxelBox, dims: [u32; 3]) -> ([Range<u32>; 3], VoxelBox) {
        // A texel has the first voxels of the next one along x too, and one of more than a row those along y.
        let sides = self.sides();
        let shared = [1, u32::from(self.texel.words > 1), 0];
        let cubes = std::array::from_fn(|k| {
            let first = region.min[k].saturating_sub(shared[k]) / sides[k];
            first..region.max[k].div_ceil(sides[k])
        });
        let voxels = VoxelBox {
            min: std::array::from_fn(|k| cubes[k].start * sides[k]),
            max: std::array::from_fn(|k| (cubes[k].end * sides[k] + shared[k]).min(dims[k])),
        };
        (cubes, voxels)
    }

    /// The voxels that are looked at where those of `region` change, in a volume of `dims`.
    pub(crate) fn looks_at(&self, region: VoxelBox, dims: [u32; 3]) -> VoxelBox {
        self.cubes_of(region, dims).1
    }

    /// What changes with the voxels of `region`; `part` holds all that is looked at.
    pub(crate) fn changed(
        &self,
        part: &VoxelPart,
        region: VoxelBox,
        dims: [u32; 3],
    ) -> ChangedCorners {
        match part.voxels {
            Voxels::U8(voxels) => self.changed_codes(voxels, part, region, dims),
            Voxels::I8(voxels) => self.changed_codes(voxels, part, region, dims),
            Voxels::U16(voxels) => self.changed_codes(voxels, part, region, dims),
            Voxels::I16(voxels) => self.changed_codes(voxels, part, region, dims),
            _ => unreachable!("corners are of codes"),
        }
    }

    fn changed_codes<C: Code>(
        &self,
        codes: &[C],
        part: &VoxelPart,
        region: VoxelBox,
        dims: [u32; 3],
    ) -> ChangedCorners {
        let ([xs, ys, zs], voxels) = self.cubes_of(region, dims);
        let sides = self.sides();
        let [along_x, along_y] = [0, 1].map(|k| u64::from(dims[k].div_ceil(sides[k])));
        let run = C::TEXEL.cube_words() * xs.len();
        let width = voxels.dims()[0] as usize;
        let mut changed = ChangedCorners {
            texel_bytes: C::TEXEL.bytes(),
            ..ChangedCorners::default()
        };
        let mut longer = Vec::new();
        for (z, y) in zs.flat_map(|z| ys.clone().map(move |y| (z, y))) {
            let mut rows = voxels;
            for (k, cube) in [(1, y), (2, z)] {
                rows.min[k] = cube * sides[k];
                rows.max[k] = voxels.max[k].min((cube + 1) * sides[k] + u32::from(k == 1));
            }
            let mut cubes = vec![0; run];
            let height = rows.dims()[1] as usize;
            let placed = part.rows(rows).map(|first| &codes[first..first + width]);
            for (index, row) in placed.enumerate() {
                let place = RowPlace {
                    y: index % height,
                    z: index / height,
                    is_last: rows.min[1] + (index % height) as u32 == dims[1] - 1,
                    cubes: xs.len(),
                };
                put_row(row, &mut longer, place, &mut cubes);
            }
            let cube = u64::from(xs.start) + along_x * (u64::from(y) + along_y * u64::from(z));
            changed.put(CUBE_TEXELS as u64 * cube, &cubes);
        }
        changed
    }

    /// Records a run of what [`FootprintTexels::changed`] gave, from byte `first` of `staging` on: between what reads them
    /// before and what reads them later.
    ///
    /// # Errors
    /// A staging buffer that is too small.
    ///
    /// # Safety
    /// `cmd` is recording on their device, outside rendering; they and `staging` live until it has run, and `staging`
    /// holds the words then; [`FootprintTexels::record_upload`] was recorded before.
    pub(crate) unsafe fn record_changed(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        run: &[Region],
        staging: &Buffer,
        first: u64,
    ) -> Result<(), Error> {
        let (read, write) = (Use::SampledOrRead, Use::TransferWrite);
        let mut offset = first;
        // SAFETY: the caller's promises; the two barriers put the copies between earlier and later uses.
        unsafe {
            image_barrier(gpu, cmd, &self.image, read, write);
            for &region in run {
                buffer_to_image(gpu, cmd, staging, offset, &self.image, region)?;
                offset += self.texel.bytes() * u64::from(region.extent[0]);
            }
            image_barrier(gpu, cmd, &self.image, write, read);
        }
        Ok(())
    }
}

impl ChangedCorners {
    /// The copies in runs of no more than so many bytes, with the byte of `words` that each begins at.
    pub fn runs(&self, bytes: u64) -> Vec<(u64, Vec<Region>)> {
        let mut runs: Vec<(u64, Vec<Region>)> = Vec::new();
        let (mut at, mut room) = (0, 0);
        for &copy in &self.copies {
            let length = self.texel_bytes * u64::from(copy.extent[0]);
            match runs.last_mut() {
                Some((_, run)) if length <= room => run.push(copy),
                _ => {
                    runs.push((at, vec![copy]));
                    room = bytes;
                }
            }
            at += length;
            room = room.saturating_sub(length);
        }
        runs
    }

    /// The words of texels from number `first` of the image on, row by row of it.
    fn put(&mut self, first: u64, words: &[u32]) {
        let width = u64::from(CORNERS_WIDTH);
        let (mut at, end) = (first, first + 4 * words.len() as u64 / self.texel_bytes);
        while at < end {
            let count = (width - at % width).min(end - at);
            self.copies.push(Region {
                origin: [(at % width) as u32, (at / width) as u32, 0],
                extent: [count as u32, 1, 1],
            });
            at += count;
        }
        self.words.extend_from_slice(words);
    }
}
